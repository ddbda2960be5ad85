#include "astroid/reports/tables.hpp"

namespace astroid {

namespace {

/// A value and its error as two columns.
template <class Row>
void add_value(std::vector<Column<Row>>& columns, const std::string& name, const std::string& unit,
               const std::string& meaning, FocalPlaneValue Row::*of) {
  columns.push_back({name, unit, meaning, [of](const Row& r) { return Cell((r.*of).value); }});
  columns.push_back({name + "_err", unit, "its standard error", [of](const Row& r) { return Cell((r.*of).error); }});
}

template <class Row>
void add_values(std::vector<Column<Row>>& columns) {
  add_value(columns, "nsr_predicted_ppm", "ppm",
            "predicted noise of one bin with all cameras at the reference magnitude", &Row::nsr_predicted);
  add_value(columns, "nsr_measured_ppm", "ppm", "the same times measured over predicted noise within bins",
            &Row::nsr_measured);
  add_value(columns, "spr", "", "median of the neighbours' share of star light in the aperture", &Row::spr);
  add_value(columns, "recovery", "mag",
            "mean of measured - true magnitude that contamination and aperture do not explain", &Row::recovery);
}

template <class Row>
Column<Row> place(const char* name, const char* meaning, double Row::*of) {
  return {name, "px", meaning, [of](const Row& r) { return Cell(r.*of); }};
}

}  // namespace

std::span<const Column<SubFieldMetrics>> focal_plane_columns() {
  static const std::vector<Column<SubFieldMetrics>> columns = [] {
    using R = SubFieldMetrics;
    std::vector<Column<R>> c;
    c.push_back(place("x", "column of the centre of the sub-field", &R::x));
    c.push_back(place("y", "row of the centre of the sub-field", &R::y));
    c.push_back({"columns", "px", "width of the sub-field",
                 [](const R& r) { return Cell(static_cast<std::int64_t>(r.area.nx)); }});
    c.push_back({"rows", "px", "height of the sub-field",
                 [](const R& r) { return Cell(static_cast<std::int64_t>(r.area.ny)); }});
    c.push_back({"targets", "", "targets in the sub-field", [](const R& r) { return Cell(r.targets); }});
    c.push_back(
        {"clean", "", "clean targets within a magnitude of the reference", [](const R& r) { return Cell(r.clean); }});
    add_values(c);
    return c;
  }();
  return columns;
}

std::span<const Column<FocalPlaneMapRow>> focal_plane_map_columns() {
  static const std::vector<Column<FocalPlaneMapRow>> columns = [] {
    using R = FocalPlaneMapRow;
    std::vector<Column<R>> c;
    c.push_back(place("x", "column", &R::x));
    c.push_back(place("y", "row", &R::y));
    add_values(c);
    return c;
  }();
  return columns;
}

}  // namespace astroid
