#include <string>
#include <vector>

#include <crashsim/load_cell_wall.hpp>

#include "bindings.hpp"
#include "keywords.hpp"
#include "long_call.hpp"
#include "paths.hpp"
#include "value_class.hpp"

namespace crashsim::python {
namespace {

void bind_wall_classes(py::module_& module) {
  ValueClass<WallStrip>(module, "WallStrip", "The cells of one row or column of a load-cell wall, added up.")
      .field("name", &WallStrip::name, "Of a row 'a', 'b', ... (1 is a); of a column '01'.")
      .field("height_m", &WallStrip::height_m, "Height of a row's middle [m]; NaN for columns.")
      .field("force_n", &WallStrip::force_n, "Force [N], positive where it stops the vehicle; read-only, of n.");
  ValueClass<LoadCellWall>(module, "LoadCellWall", "The force of a load-cell wall over time, n samples.")
      .field("time_s", &LoadCellWall::time_s, "Times from impact on the trace's clock [s]; also before impact.")
      .field("total_force_n", &LoadCellWall::total_force_n, "Total force [N], positive where it stops the vehicle.")
      .field("force_height_m", &LoadCellWall::force_height_m,
             "Height of the total force [m]; where that is below 5 % of its largest, between the heights around.")
      .field("rows", &LoadCellWall::rows, "Every row as a WallStrip, first row first.")
      .field("cell_columns", &LoadCellWall::cell_columns, "Every column of cells; empty when made of row sums.")
      .field("cells", &LoadCellWall::cells, "Number of cells, or row sums, that were added up.")
      .field("coverage", &LoadCellWall::coverage, "Their share of the rectangle that all known cells span.")
      .field("excluded", &LoadCellWall::excluded, "Cells left out, and why.")
      .field("end_s", &LoadCellWall::end_s, "End of impulse and mean height, after impact, inside the record [s].")
      .field("steps", &LoadCellWall::steps, "What was done, in order.")
      .field("warnings", &LoadCellWall::warnings, "What looked unusual.")
      .field("input_files", &LoadCellWall::input_files, "Every file read.");
  ValueClass<WallNumbers>(module, "WallNumbers",
                          "Numbers of a load-cell wall; those of crush need the vehicle's motion.")
      .numbers(kWallNumbers);
}

void bind_wall_reading(py::module_& module) {
  module.def(
      "read_wall",
      [](const py::object& path, const py::kwargs& keywords) {
        const std::string file = path_text(path);
        const auto options = options_from<WallOptions>(keywords, "read_wall");
        return unlocked([&] { return read_wall(file, options); });
      },
      py::arg("path"),
      with_options_doc<WallOptions>(R"(Reads the barrier's load cells and puts the wall together.

Parameters
----------
path : str or os.PathLike
    Trace file or folder of any format that read_traces reads.
**options
    See below.

Returns
-------
LoadCellWall

Raises
------
InvalidInput
    When the file cannot be read, no cell is left, or an option is out of range.)")
          .c_str());
  module.def(
      "assemble_wall",
      [](const TraceSet& traces, const py::kwargs& keywords) {
        const auto options = options_from<WallOptions>(keywords, "assemble_wall");
        return unlocked([&] { return assemble_wall(traces, options); });
      },
      py::arg("traces"),
      with_options_doc<WallOptions>(R"(Puts a wall together from the barrier's longitudinal forces.

Cells are known by sensor location ("LC1101": row 11, column 1; "LCA1": row A) or comment ("BARRIER K-01 Fx"); in an
NHTSA test also by VEHNO 0, load cell, axis X and dimension force together. Row sums are known by the name ``row_a...`` or
chosen. Cells that are flagged bad, absent, without change, beyond their range, not finite or on another clock are left
out and named. The mean before impact is taken off each row (from 10 samples on).

Parameters
----------
traces : TraceSet
    Channels read, as by read_traces.
**options
    See below.

Returns
-------
LoadCellWall

Raises
------
InvalidInput
    When no cell is left, or an option is out of range.)")
          .c_str());
  module.def(
      "wall_channels",
      [](const TraceSet& catalogue, const py::kwargs& keywords) {
        return wall_channels(catalogue, options_from<WallOptions>(keywords, "wall_channels"));
      },
      py::arg("catalogue"),
      with_options_doc<WallOptions>(R"(Indices of the good cells or row sums in a catalogue.

Parameters
----------
catalogue : TraceSet
    Channels of a file, with or without samples.
**options
    See below.

Returns
-------
list of int
    Indices into ``catalogue.traces``.

Raises
------
InvalidInput
    When an option is out of range.)")
          .c_str());
}

void bind_wall_judgement(py::module_& module) {
  module.def(
      "wall_numbers",
      [](const LoadCellWall& wall, const Pulse* pulse) { return unlocked([&] { return wall_numbers(wall, pulse); }); },
      py::arg("wall"), py::arg("pulse") = py::none(),
      R"(Peak force, impulse, heights of force and work-equivalent stiffness of a load-cell wall.

Parameters
----------
wall : LoadCellWall
    The wall.
pulse : Pulse, optional
    Motion of the vehicle in the same test, with its mass; without it the numbers of crush and momentum are NaN.

Returns
-------
WallNumbers

Raises
------
InvalidInput
    When wall or pulse hold bad series.
)");
  module.def("check_momentum", &check_momentum, py::arg("numbers"),
             R"(Warnings where the wall's impulse and the vehicle's change of momentum differ by more than 10 %.

Parameters
----------
numbers : WallNumbers
    Of a wall and a pulse of one test.

Returns
-------
list of str
    Empty when they agree or one is not known.

Raises
------
TypeError
    When `numbers` is no WallNumbers.
)");
}

}  // namespace

void bind_wall(py::module_& module) {
  bind_wall_classes(module);
  bind_wall_reading(module);
  bind_wall_judgement(module);
}

}  // namespace crashsim::python
