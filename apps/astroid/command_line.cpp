#include "command_line.hpp"

#include <CLI/CLI.hpp>
#include <functional>
#include <string>

#include "astroid/core/error.hpp"
#include "commands/commands.hpp"

namespace astroid {

namespace {

using namespace commands;

/// Without this a number below 0 would be taken modulo 2^64.
std::string not_negative(const std::string& text) {
  return text.starts_with('-') ? text + " is below 0" : std::string();
}

void add_configuration(CLI::App* app, ConfigurationOptions& options) {
  app->add_option("CONFIG", options.configuration, "configuration file, or the name of a mission preset (plato)")
      ->required();
  app->add_option("--set", options.set, "override a parameter: Path/To/Parameter=value (repeatable)")
      ->type_name("PATH=VALUE")
      ->allow_extra_args(false);
  app->add_option("--seed", options.seed, "override Simulation/Seed")->type_name("N")->check(not_negative);
}

void add_overwrite(CLI::App* app, bool& overwrite) {
  app->add_flag("--overwrite", overwrite, "replace what is already there");
}

void add_run_folder(CLI::App* app, RunFolderOptions& options, const std::string& fallback) {
  options.folder = fallback;
  app->add_option("-o,--output", options.folder, "folder of the products")->type_name("DIR")->capture_default_str();
  app->add_flag("--overwrite", options.overwrite, "replace the folder if it exists");
  app->add_option("--threads", options.threads, "worker threads (default: all processors)")
      ->type_name("N")
      ->check(CLI::Range(1, 1024));
  app->add_flag("-v,--verbose", options.verbose, "say where the time went");
}

/// A misspelt command, or an option before it, is named in the message. @throws InputError
void check_command(const CLI::App& app, int argc, char** argv) {
  if (argc < 2) return;
  const std::string given = argv[1];
  const bool is_option = given.starts_with('-');
  if (is_option && app.get_option_no_throw(given) != nullptr) return;
  std::string known;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    if (command->get_name() == given) return;
    known += (known.empty() ? "" : ", ") + command->get_name();
  }
  throw InputError(
      Problem{.parameter = is_option ? given : "COMMAND",
              .value = is_option ? "" : given,
              .expected = (is_option ? "astroid COMMAND and then its options; the commands are " : "one of ") + known,
              .message = is_option ? "no option of the program itself" : "there is no such command"});
}

}  // namespace

int run_command_line(int argc, char** argv) {
  CLI::App app{"ASTROID finds out, before launch, how well a space camera will measure stars."};
  app.name("astroid");
  app.set_version_flag("--version", std::string("astroid ") + ASTROID_VERSION);
  app.require_subcommand(1);
  app.footer("Each command explains itself with -h. A first run: astroid assess plato -o out/plato");
  std::function<int()> command;

  AssessOptions assess_options;
  assess_options.run.command_line.assign(argv, argv + argc);
  CLI::App* sub = app.add_subcommand("assess", "the main job: simulate, calibrate, measure, analyse and report");
  add_configuration(sub, assess_options.configuration);
  add_run_folder(sub, assess_options.run, "out/assess");
  sub->add_option("--dump-steps", assess_options.dump_steps,
                  "write the maps after each step of these exposures as FITS")
      ->delimiter(',')
      ->type_name("N,N");
  sub->callback([&] { command = [&] { return assess(assess_options); }; });

  AssessOptions simulate_options;
  simulate_options.run.command_line.assign(argv, argv + argc);
  sub = app.add_subcommand("simulate", "images and truth only");
  add_configuration(sub, simulate_options.configuration);
  add_run_folder(sub, simulate_options.run, "out/simulate");
  sub->add_option("--dump-steps", simulate_options.dump_steps,
                  "write the maps after each step of these exposures as FITS")
      ->delimiter(',')
      ->type_name("N,N");
  sub->callback([&] { command = [&] { return simulate(simulate_options); }; });

  FocalPlaneCommand focal_plane_options;
  focal_plane_options.run.run.command_line.assign(argv, argv + argc);
  sub = app.add_subcommand(
      "focal-plane", "maps of noise, contamination and recovery over the detector, from sub-fields spread over it");
  add_configuration(sub, focal_plane_options.run.configuration);
  add_run_folder(sub, focal_plane_options.run.run, "out/focal-plane");
  sub->add_option("--across", focal_plane_options.across, "sub-fields along the columns")
      ->check(CLI::Range(1, 100))
      ->capture_default_str();
  sub->add_option("--down", focal_plane_options.down, "sub-fields along the rows")
      ->check(CLI::Range(1, 100))
      ->capture_default_str();
  sub->add_option("--side", focal_plane_options.side, "side of each")
      ->type_name("PX")
      ->check(CLI::Range(8, 100000))
      ->capture_default_str();
  sub->add_option("--group", focal_plane_options.group, "of cameras, where the mission has several")
      ->capture_default_str();
  sub->add_option("--magnitude", focal_plane_options.magnitude, "of the star that is mapped (default: targets' median)")
      ->type_name("MAG");
  sub->callback([&] { command = [&] { return focal_plane(focal_plane_options); }; });

  TradeoffCommand tradeoff_options;
  tradeoff_options.run.run.command_line.assign(argv, argv + argc);
  sub = app.add_subcommand("tradeoff", "what accuracy costs in time, measured for your own scene, and what to choose");
  add_configuration(sub, tradeoff_options.run.configuration);
  add_run_folder(sub, tradeoff_options.run.run, "out/tradeoff");
  sub->add_option("--exposures", tradeoff_options.exposures, "that methods of photometry are compared on")
      ->check(CLI::Range(2, 1000000))
      ->capture_default_str();
  sub->add_option("--seconds", tradeoff_options.seconds, "CPU time of each timing")
      ->type_name("S")
      ->check(CLI::Range(0.001, 1000.0))
      ->capture_default_str();
  sub->callback([&] { command = [&] { return tradeoff(tradeoff_options); }; });

  PhotometryOptions photometry_options;
  sub = app.add_subcommand("photometry", "fluxes of stars in any FITS images, found there or given by a catalogue");
  sub->add_option("IMAGE", photometry_options.images, "FITS images")->required();
  sub->add_option("--catalogue", photometry_options.catalogue,
                  "positions: a catalogue with ra,dec (the image needs a WCS) or x,y; without it stars are found")
      ->type_name("FILE");
  sub->add_option(
         "--method", photometry_options.method,
         "aperture, mask (optimal binary), weighted, psf (neighbours fitted too), or auto: what suits the scene, "
         "and it says why")
      ->check(CLI::IsMember({"auto", "aperture", "mask", "weighted", "psf"}))
      ->capture_default_str();
  sub->add_option("--psf", photometry_options.psf, "a FITS file, or gaussian:SIGMA_PX; all but apertures need it")
      ->type_name("PSF");
  sub->add_option("--threshold", photometry_options.threshold,
                  "of stars that are found, in units of their noise (default: 5)")
      ->type_name("SIGMA");
  sub->add_option("--radius", photometry_options.radius,
                  "of apertures (default: 3; of stars that are found 1.2 FWHM, in a crowd 0.8)")
      ->type_name("PX");
  sub->add_option(
         "--correct-to", photometry_options.correct_to,
         "correct apertures to this radius by the growth of bright stars (default: 4 FWHM where the radius was "
         "not given either)")
      ->type_name("PX");
  sub->add_option("--background", photometry_options.background,
                  "local, mesh, or a known level in the image's unit (default: local; mesh for stars that are found)");
  sub->add_option("--annulus", photometry_options.annulus, "radii of the local background (default: 5 8)")
      ->type_name("PX PX")
      ->expected(2);
  sub->add_option("--clip", photometry_options.clip,
                  "leave out pixels of the annulus so many sigma from its median (default: 3; 0: none)")
      ->type_name("SIGMA");
  sub->add_option(
         "--residual", photometry_options.residual,
         "write the image without its background and its stars, as their PSF says (without --psf a Gaussian of "
         "the measured width)")
      ->type_name("FILE");
  sub->add_option("--gain", photometry_options.gain, "if the header does not say it")->type_name("E-/ADU");
  sub->add_option("--read-noise", photometry_options.read_noise, "if the header does not say it")->type_name("E-");
  sub->add_option("--bias", photometry_options.bias,
                  "pedestal without photon noise, if neither header nor prescan says it (default: 0)")
      ->type_name("ADU");
  sub->add_flag("--ignore-overscan", photometry_options.ignore_overscan,
                "do not subtract what OVERSCAN extensions show from the columns of the image");
  sub->add_option("--saturation", photometry_options.saturation, "if the header does not say it")->type_name("ADU");
  sub->add_option("--zero-point", photometry_options.zero_point, "magnitude of one electron per second")
      ->type_name("MAG");
  sub->add_option("--exposure-time", photometry_options.exposure_time, "if the header does not say it")->type_name("S");
  sub->add_option("-o,--output", photometry_options.output,
                  "table of fluxes, CSV or FITS by its name; how they were measured goes to FILE.json beside a CSV")
      ->type_name("FILE")
      ->capture_default_str();
  add_overwrite(sub, photometry_options.overwrite);
  sub->callback([&] { command = [&] { return photometry(photometry_options); }; });

  AnalyseOptions analyse_options;
  sub = app.add_subcommand("analyse", "metrics and report of a finished run, or of fluxes and truth given by hand");
  sub->add_option("DIR", analyse_options.folder, "folder of a finished run")->type_name("DIR");
  sub->add_option("--truth", analyse_options.truth, "truth table (id,x,y,mag,electrons), with --sources")
      ->type_name("FILE");
  sub->add_option("--sources", analyse_options.sources, "table of fluxes as `astroid photometry` writes it")
      ->type_name("FILE");
  sub->add_option("--set", analyse_options.set, "override a parameter, such as Analysis/Bin=7200 s")
      ->type_name("PATH=VALUE")
      ->allow_extra_args(false);
  sub->add_option("--export", analyse_options.export_ids,
                  "write the light curves of these stars as files that lightkurve opens")
      ->type_name("ID")
      ->delimiter(',');
  sub->add_option("-o,--output", analyse_options.output, "folder of the results (default: the run's own)")
      ->type_name("DIR");
  add_overwrite(sub, analyse_options.overwrite);
  sub->add_option("--threads", analyse_options.threads, "worker threads (default: all processors)")
      ->type_name("N")
      ->check(CLI::Range(1, 1024));
  sub->callback([&] { command = [&] { return analyse(analyse_options); }; });

  PlanOptions plan_options;
  sub = app.add_subcommand("plan", "what would be computed, why, and its predicted time, memory and error");
  add_configuration(sub, plan_options.configuration);
  sub->add_flag("--json", plan_options.json, "as JSON");
  sub->callback([&] { command = [&] { return plan(plan_options); }; });

  BudgetOptions budget_options;
  sub = app.add_subcommand("budget", "the noise budget by source and magnitude");
  add_configuration(sub, budget_options.configuration);
  sub->add_flag("--analytic", budget_options.analytic, "the prediction alone, in milliseconds")->required();
  sub->add_option("--from", budget_options.mag_from, "brightest magnitude")->type_name("MAG")->capture_default_str();
  sub->add_option("--to", budget_options.mag_to, "faintest magnitude")->type_name("MAG")->capture_default_str();
  sub->add_option("--step", budget_options.mag_step, "step")
      ->type_name("MAG")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  sub->add_option("--neighbour", budget_options.neighbours,
                  "a star beside each: columns and rows from it, and magnitudes fainter (repeatable)")
      ->type_name("DX,DY,DMAG")
      ->allow_extra_args(false);
  sub->add_option("-o,--output", budget_options.output, "write the table as CSV")->type_name("FILE");
  add_overwrite(sub, budget_options.overwrite);
  sub->callback([&] { command = [&] { return budget(budget_options); }; });

  FieldOptions field_options;
  sub = app.add_subcommand("field", "make a synthetic star field, or extend a catalogue to faint magnitudes");
  sub->add_option("--extend", field_options.extend, "catalogue to extend")->type_name("FILE");
  sub->add_option("--ra", field_options.ra, "centre")->type_name("DEG");
  sub->add_option("--dec", field_options.dec, "centre")->type_name("DEG");
  sub->add_option("--radius", field_options.radius, "of a round field")->type_name("DEG");
  sub->add_option("--width", field_options.width, "of a rectangular field, along right ascension on the sky")
      ->type_name("DEG");
  sub->add_option("--height", field_options.height, "of a rectangular field, along declination")->type_name("DEG");
  sub->add_option("--number", field_options.number, "number of stars")->type_name("N");
  sub->add_option("--density", field_options.density, "stars per square degree, instead of --number")
      ->type_name("N/DEG2");
  sub->add_option("--bright", field_options.bright, "brightest magnitude")->type_name("MAG")->capture_default_str();
  sub->add_option("--faint", field_options.faint, "faintest magnitude")->type_name("MAG")->capture_default_str();
  sub->add_option("--slope", field_options.slope,
                  "of the counts: N grows as 10^(slope mag) (default: 0.35, or the catalogue's own)");
  sub->add_flag("--only-new", field_options.only_new,
                "with --extend: write the added stars alone, for StellarField/BackgroundCatalogue");
  sub->add_option("--complete-to", field_options.complete_to,
                  "magnitude to which the extended catalogue is complete (default: its turn-over)")
      ->type_name("MAG");
  sub->add_option("--passband", field_options.passband, "of the magnitudes")->capture_default_str();
  sub->add_option("--seed", field_options.seed, "of the random numbers")
      ->type_name("N")
      ->capture_default_str()
      ->check(not_negative);
  sub->add_option("-o,--output", field_options.output, "catalogue to write (CSV)")->type_name("FILE")->required();
  add_overwrite(sub, field_options.overwrite);
  sub->callback([&] { command = [&] { return field(field_options); }; });

  std::string mission;
  std::string init_output;
  bool init_overwrite = false;
  sub = app.add_subcommand("init", "write a mission preset to start from");
  sub->add_option("MISSION", mission, "plato")->required();
  sub->add_option("-o,--output", init_output, "file to write (default: MISSION.xml)")->type_name("FILE");
  add_overwrite(sub, init_overwrite);
  sub->callback([&] { command = [&] { return init(mission, init_output, init_overwrite); }; });

  ConfigurationOptions validate_options;
  bool schema = false;
  sub = app.add_subcommand("validate", "check a configuration and list every problem");
  sub->add_option("CONFIG", validate_options.configuration, "configuration file, or the name of a mission preset");
  sub->add_option("--set", validate_options.set, "override a parameter")
      ->type_name("PATH=VALUE")
      ->allow_extra_args(false);
  sub->add_flag("--schema", schema, "print the XML schema (XSD) for editors and xmllint instead");
  sub->callback([&] { command = [&] { return validate(validate_options, schema); }; });

  std::string parameter;
  sub = app.add_subcommand("explain", "what a parameter means, its unit, range and default");
  sub->add_option("PARAMETER", parameter, "CCD/Gain, Gain, or a section; nothing for the list");
  sub->callback([&] { command = [&] { return explain(parameter); }; });

  bool calibrate = false;
  sub = app.add_subcommand("doctor", "versions of everything the program runs on, and what is missing");
  sub->add_flag("--calibrate", calibrate, "measure this machine (some seconds), so that plans predict its times");
  sub->callback([&] { command = [&] { return doctor(calibrate); }; });

  check_command(app, argc, argv);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    const int code = app.exit(error);
    return code == 0 ? 0 : static_cast<int>(ExitCode::kInput);
  }
  return command();
}

}  // namespace astroid
