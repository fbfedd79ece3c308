#pragma once

#include <algorithm>
#include <ostream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace akmon::test::broken_bars
{
  /// A broken variant of the two bars; SCRATCH stands for the directory of the test.
  struct Variant
  {
    std::string name;
    std::vector<std::pair<std::string, std::string>> edits; ///< of two_bars.prm: text -> text
    std::vector<std::string> overrides;
    std::vector<std::string> expected; ///< parts of the message
    std::string appended             = "";
    std::vector<std::string> without = {}; ///< sections to leave out
  };


  inline std::ostream &
  operator<<(std::ostream &out, const Variant &variant)
  {
    return out << variant.name;
  }


  inline const std::string mesh_of_one_tetrahedron = R"($MeshFormat
2.2 0 8
$EndMeshFormat
$Nodes
4
1 0 0 0
2 1 0 0
3 0 1 0
4 0 0 1
$EndNodes
$Elements
1
1 4 2 1 1 1 2 3 4
$EndElements
)";

  inline const std::string floor_at_zero = R"(
subsection Obstacles
  set Names = floor
  subsection floor
    set Surfaces = right
    set Point    = 0, 0, -0.25
    set Normal   = 0, 0, 1
  end
end
)";

  inline const std::string symmetry_everywhere = R"(
subsection Prescribed motion
  set Names = fold
  subsection fold
    set Type     = symmetry
    set Surfaces = left
  end
end
)";

  inline const std::string shape_box = "set Shape    = box";


  inline const std::vector<Variant> variants =
    {{"unknown_key",
      {{"set Density ", "set Densty "}},
      {},
      {"line 20: [Materials/elastic] Densty = 7.337e-4", "no such key", "Density, "}},
     {"unknown_key_at_the_top",
      {{"set Title ", "set Titel "}},
      {},
      {"line 9: Titel = Two", "no such key", "Output directory, Title"}},
     {"unknown_section",
      {{"subsection Time", "subsection Tyme"}},
      {},
      {"line 12: [Tyme]", "no such section", "Materials, ", "Time"}},
     {"section_that_is_not_in_names",
      {{"set Names = left, right", "set Names = right"}},
      {},
      {"line 28: [Bodies/left]", "allowed are right (the Names of [Bodies])"}},
     {"word_for_a_number",
      {{"set Density         = 7.337e-4", "set Density = heavy"}},
      {},
      {"line 20: [Materials/elastic] Density = heavy: allowed are numbers"}},
     {"brace",
      {{"set Density         = 7.337e-4", "set Density = {7.337e-4"}},
      {},
      {"line 20: [Materials/elastic] Density = {7.337e-4: braces are not allowed here"}},
     {"two_numbers_for_a_vector",
      {{"= 202.2, 0, 0", "= 202.2, 0"}},
      {},
      {"[Bodies/left] Velocity = 202.2, 0: allowed are 3 numbers separated by commas"}},
     {"fraction_for_an_integer",
      {{"set Cells = 20, 4, 4", "set Cells = 20, 4, .5"}},
      {},
      {"[Bodies/left/Box] Cells = 20, 4, .5: allowed are 3 integers not below 1"}},
     {"number_out_of_range",
      {{"set Step ", "set Safety factor = 1.5 # "}},
      {},
      {"[Time] Safety factor = 1.5: allowed are numbers from 0 to 1"}},
     {"unknown_shape",
      {{shape_box, "set Shape = blob"}},
      {},
      {"[Bodies/left] Shape = blob: allowed are box, cylinder, hollow cylinder, sphere, file"}},
     {"missing_material",
      {{"set Material = elastic", "set Material ="}},
      {},
      {"[Bodies/left] Material = (none): allowed are"}},
     {"unknown_material",
      {{"set Material = elastic", "set Material = rubber"}},
      {},
      {"[Bodies/left] Material = rubber: there is no such material; allowed are elastic"}},
     {"unknown_boundary",
      {{"left:x+", "left:top"}},
      {},
      {"[Contact/interface] Slave = left:top", "all, x+, x-, y+"}},
     {"unknown_body",
      {{"right:x-", "wrong:x-"}},
      {},
      {"[Contact/interface] Master = wrong", "allowed are left, right"}},
     {"unknown_body_of_a_probe",
      {{"set Body  = left", "set Body = wrong"}},
      {},
      {"[Probes/left_face] Body = wrong", "allowed are left, right"}},
     {"negative_density",
      {{"set Density         = 7.337e-4", "set Density = -7.337e-4"}},
      {},
      {"[Materials/elastic] Density = -7.337e-4: allowed are positive numbers"}},
     {"incompressible",
      {{"set Poisson's ratio = 0", "set Poisson's ratio = .5"}},
      {},
      {"[Materials/elastic] Poisson's ratio = .5: allowed are numbers above -1 and below 0.5"}},
     {"absent_mesh",
      {{shape_box, "set Shape = file"}},
      {"Bodies/left/File/Name=no_such_mesh.msh"},
      {"[Bodies/left/File] Name = no_such_mesh.msh: there is no such file"}},
     {"tetrahedral_mesh",
      {{shape_box, "set Shape = file"}},
      {"Bodies/left/File/Name=SCRATCH/tetrahedron.msh"},
      {"[Bodies/left/File] Name = SCRATCH/tetrahedron.msh", "tetrahedra"}},
     {"shallow_overlap",
      {{"set Position = -5.01, 0, 0", "set Position = -4.98, 0, 0"}, {"-0.01, 0, 0", "0.02, 0, 0"}},
      {},
      {"'left'", " deep", "at (0.0", "apart"}},
     {"overlap_by_three_lengths",
      {{"set Position = -5.01, 0, 0", "set Position = -1.99, 0, 0"}},
      {},
      {"[Bodies]", "'left'", "'right'", "0.5 deep", "at (", "apart"},
      "",
      {"Probes"}},
     {"body_completely_inside",
      {{"set Size  = 10, 1, 1", "set Size = 1, .5, .5"},
       {"set Position = -5.01, 0, 0", "set Position = 5.01, 0, 0"}},
      {},
      {"[Bodies]", "'left' is 0.5 deep inside 'right' at (", "apart"},
      "",
      {"Probes"}},
     {"overlap_without_a_contact_pair",
      {{"set Position = -5.01, 0, 0", "set Position = -1.99, 0, 0"}},
      {},
      {"[Bodies]", "'left'", "'right'", "0.5 deep"},
      "",
      {"Probes", "Contact"}},
     {"overlap_with_an_obstacle",
      {},
      {},
      {"[Obstacles/floor] body 'right'", "0.25 deep at (", "-0.5)"},
      floor_at_zero},
     {"output_below_a_file",
      {},
      {"Output directory=/dev/null/results"},
      {"output directory '/dev/null/results' cannot be written: "}},
     {"no_bodies",
      {},
      {},
      {"[Bodies] Names = (none): a case needs at least one body"},
      "",
      {"Bodies", "Contact", "Probes"}},
     {"no_end",
      {{"set End  = 2.0e-4", "set End = 0"}},
      {},
      {"[Time] End = 0: allowed are positive numbers"}},
     {"step_that_is_no_number",
      {{"0.7274e-6", "small"}},
      {},
      {"[Time] Step = small: allowed are positive numbers or 'automatic'"}},
     {"set_unknown_key",
      {},
      {"Time/Stop=1"},
      {"--set [Time] Stop = 1: there is no such key; allowed are Allow unstable step, "
       "Critical step, End, Mass scaling step, Safety factor, Smallest step, Step"}},
     {"set_unknown_section",
      {},
      {"Tyme/End=1"},
      {"--set [Tyme] End = 1: there is no such section; allowed are ", "Time"}},
     {"set_unknown_item",
      {},
      {"Bodies/middle/Shape=box"},
      {"--set [Bodies/middle] Shape = box", "allowed are left, right (the Names of [Bodies])"}},
     {"set_unknown_key_at_the_top", {}, {"Titel=x"}, {"--set Titel = x: there is no such key"}},
     {"set_without_value",
      {},
      {"Time/End"},
      {"--set Time/End: allowed is \"Section/Sub/Key=value\""}},
     {"set_without_key", {}, {"=1"}, {"--set =1: allowed is \"Section/Sub/Key=value\""}},
     {"set_wrong_type",
      {},
      {"Time/End=soon"},
      {"--set [Time] End = soon: allowed are numbers not below 0"}},
     {"missing_end",
      {{"set Step = 0.7274e-6\nend", "set Step = 0.7274e-6"}},
      {},
      {"end of the file comes within section [Time]", "'end' is missing"}},
     {"one_end_too_many",
      {{"set Step = 0.7274e-6\nend", "set Step = 0.7274e-6\nend\nend"}},
      {},
      {"line 16: an 'end' without its subsection"}},
     {"line_that_is_no_statement",
      {{"set Title ", "put Title "}},
      {},
      {"line 9: 'put Title", "is not understood", "'set KEY = VALUE'"}},
     {"probe_outside",
      {{"set Point = -5.01, 0, 0", "set Point = -5.01, 7, 0"}},
      {},
      {"[Probes/left_middle] Point = -5.01, 7, 0", "body 'left'", "6.5"}},
     {"symmetry_surface_that_is_not_plane",
      {},
      {},
      {"[Prescribed motion/fold] Surfaces = left: a symmetry plane must be a plane surface"},
      symmetry_everywhere},
     {"function_that_cannot_be_read",
      {},
      {"Body force/Acceleration=0; sin(; 0"},
      {"[Body force] Acceleration = 0; sin(; 0"}},
     {"function_of_an_unknown_name",
      {},
      {"Body force/Acceleration=0; 0; -g"},
      {"[Body force] Acceleration = 0; 0; -g"}},
     {"function_with_one_component",
      {},
      {"Body force/Acceleration=-9.81"},
      {"[Body force] Acceleration = -9.81: allowed are three expressions"}},
     {"duplicate_names",
      {{"set Names = left, right", "set Names = left, right, left"}},
      {},
      {"[Bodies] Names = left, right, left: 'left' stands twice"}}};


  /// The variant of a name; throws std::runtime_error if there is none.
  inline const Variant &
  variant_of(const std::string &name)
  {
    const auto found = std::find_if(variants.begin(), variants.end(), [&](const Variant &variant) {
      return variant.name == name;
    });
    if (found == variants.end())
      throw std::runtime_error("no broken variant is named '" + name + "'");
    return *found;
  }
} // namespace akmon::test::broken_bars
