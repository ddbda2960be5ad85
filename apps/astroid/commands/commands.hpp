// The commands of the program: one function and one short file each.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace astroid::commands {

/// Options that every command on a configuration takes.
struct ConfigurationOptions {
  std::string configuration;     ///< a file, or the name of a mission preset
  std::vector<std::string> set;  ///< Path/To/Parameter=value
  std::optional<std::uint64_t> seed;
};

/// Options of commands that write a folder of products.
struct RunFolderOptions {
  std::string folder;
  bool overwrite = false;
  int threads = 0;  ///< 0: all processors
  bool verbose = false;
  std::vector<std::string> command_line;  ///< for run.json
};

struct AssessOptions {
  ConfigurationOptions configuration;
  RunFolderOptions run;
  std::vector<std::int64_t> dump_steps;
};
int assess(const AssessOptions& options);
int simulate(const AssessOptions& options);

struct FocalPlaneCommand {
  AssessOptions run;
  int across = 3, down = 3, side = 200;
  int group = 1;
  std::optional<double> magnitude;
};
int focal_plane(const FocalPlaneCommand& options);

struct TradeoffCommand {
  AssessOptions run;
  std::int64_t exposures = 64;
  double seconds = 0.2;
};
int tradeoff(const TradeoffCommand& options);

struct PlanOptions {
  ConfigurationOptions configuration;
  bool json = false;
};
int plan(const PlanOptions& options);

struct BudgetOptions {
  ConfigurationOptions configuration;
  bool analytic = false;
  double mag_from = 8.0, mag_to = 13.0, mag_step = 0.5;
  std::vector<std::string> neighbours;  ///< DX,DY,DMAG each
  std::string output;                   ///< noise_budget.csv; empty: the table on the screen only
  bool overwrite = false;
};
int budget(const BudgetOptions& options);

struct PhotometryOptions {
  std::vector<std::string> images;
  std::string catalogue;
  std::string method = "auto";
  std::string psf;  ///< file or gaussian:SIGMA_PX
  bool ignore_overscan = false;
  std::optional<double> radius, correct_to, threshold, gain, read_noise, bias, saturation, zero_point, exposure_time;
  std::string background;       ///< local, mesh or a number of ADU; empty: local, or mesh where stars are found
  std::vector<double> annulus;  ///< inner and outer radius, px; empty: the default
  std::optional<double> clip;   ///< sigma, of the annulus; 0: the plain median
  std::string residual;         ///< file; empty: none
  std::string output = "sources.csv";
  bool overwrite = false;
};
int photometry(const PhotometryOptions& options);

struct AnalyseOptions {
  std::string folder;          ///< of a finished run
  std::string truth, sources;  ///< by hand
  std::vector<std::string> set;
  std::vector<std::string> export_ids;
  std::string output;
  bool overwrite = false;
  int threads = 0;
};
int analyse(const AnalyseOptions& options);

struct FieldOptions {
  std::string extend;  ///< catalogue to extend; empty: a new field
  double ra = 0.0, dec = 0.0, radius = 0.0, width = 0.0, height = 0.0;
  std::optional<std::int64_t> number;
  std::optional<double> density;  ///< stars per square degree brighter than the faint limit
  std::optional<double> density_limit;
  double bright = 6.0, faint = 15.0;
  std::optional<double> slope;
  bool only_new = false;  ///< of an extension: leave the catalogue's own stars out of the file
  std::optional<double> complete_to;
  std::string passband = "V";
  std::uint64_t seed = 1;
  std::string output;
  bool overwrite = false;
};
int field(const FieldOptions& options);

int init(const std::string& mission, const std::string& output, bool overwrite);
int validate(const ConfigurationOptions& options, bool schema);
int explain(const std::string& parameter);
/// @param calibrate  measures the machine and keeps what it finds.
int doctor(bool calibrate);

}  // namespace astroid::commands
