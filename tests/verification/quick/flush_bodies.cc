#include <gtest/gtest.h>

#include "support/kept_run.h"
#include "support/report.h"

// Bodies whose edges lie on each other, slide over each other, or are the thin sides of one: whose
// faces a node meets at the edge of a surface, and which it only passes.

namespace flush_bodies
{
  using namespace akmon::test;

  // All surfaces in one.
  const std::string contact = R"(
subsection Contact
  set Names = touch
  subsection touch
    set Slave  = all
    set Master = all
    set Friction coefficient = 0.3
  end
end
)";


  const std::string rubber_boxes = contact + R"(
subsection Materials
  set Names = rubber, stiff
  subsection rubber
    set Density         = 1000
    set Young's modulus = 1e7
    set Poisson's ratio = 0.3
  end
  subsection stiff
    set Density         = 10000
    set Young's modulus = 1e9
    set Poisson's ratio = 0.3
  end
end
subsection Obstacles
  set Names = ground
  subsection ground
    set Friction coefficient = 0.3
  end
end
subsection Body force
  set Acceleration = 0; 0; -9.81
end
)";


  std::string
  box(const std::string &name, const std::string &place, const unsigned int n_cells)
  {
    const std::string n = std::to_string(n_cells);
    return "subsection " + name +
           "\nset Material = rubber\nset Shape = box\nset Position = " + place +
           "\nsubsection Box\nset Cells = " + n + ", " + n + ", " + n + "\nend\nend\n";
  }


  std::string
  bodies(const std::string &names, const std::string &sections)
  {
    return "subsection Bodies\nset Names = " + names + "\n" + sections + "end\n";
  }


  // One on another, on unlike meshes: all surfaces as one contact, or the two faces that meet.
  TEST(FlushBoxes, meet_at_their_faces_whatever_else_is_in_the_contact)
  {
    const std::string text = rubber_boxes +
                             bodies("low, high",
                                    box("low", "0, 0, 0.5", 2) + box("high", "0, 0, 1.5", 3));
    std::vector<std::string> overrides = {"Time/End=0.1", "Obstacles/ground/Surfaces=low:z-"};
    const auto of_all                  = run_text(text, overrides);
    overrides.push_back("Contact/touch/Slave=low:z+");
    overrides.push_back("Contact/touch/Master=high:z-");
    const auto of_faces = run_text(text, overrides);

    const double penetration = largest_of(of_all.history["max_penetration_rel"]);
    const auto &rubbed       = of_all.history["friction_dissipation"];
    double least             = 0.;
    for (std::size_t i = 1; i < rubbed.size(); ++i)
      least = std::min(least, rubbed[i] - rubbed[i - 1]);
    report("penetration over h", penetration);
    report("friction dissipation over that of the faces alone",
           rubbed.back() / of_faces.history["friction_dissipation"].back());
    EXPECT_LT(penetration, 1e-8);
    EXPECT_GT(least, -1e-10);
    EXPECT_NEAR(rubbed.back(), of_faces.history["friction_dissipation"].back(), 1e-3);
    for (const char *const axis : {"x", "y"})
      {
        const std::string momentum = std::string("momentum_") + axis;
        EXPECT_LT(largest_of(of_all.history[momentum]), 1e-6);
        EXPECT_LT(largest_of(of_all.history["angular_" + momentum]), 1e-6);
      }
  }


  // A surface that meets itself is one, in whatever order its parts are named.
  TEST(OneSurface, is_known_by_its_faces)
  {
    const std::string text = rubber_boxes +
                             bodies("low, high",
                                    box("low", "0, 0, 0.5", 2) + box("high", "0.1, 0, 1.5", 3));
    const std::vector<std::string> overrides = {"Time/End=0.02",
                                                "Obstacles/ground/Surfaces=low:z-"};
    auto named                               = overrides;
    named.push_back("Contact/touch/Slave=low:all, high");
    named.push_back("Contact/touch/Master=high:all, low");
    const auto once = run_text(text, overrides), twice = run_text(text, named);
    EXPECT_GT(once.history["active_pairs"].back(), 0.);
    EXPECT_EQ(once.history["active_pairs"], twice.history["active_pairs"]);
    EXPECT_EQ(once.history["kinetic_energy"], twice.history["kinetic_energy"]);
  }


  // Side by side and on each other, on like meshes: where eight meet a node has three partners, and
  // none in the box across an edge or corner.
  TEST(FlushBoxes, keep_apart_where_eight_meet)
  {
    std::string names, sections;
    for (unsigned int i = 0; i < 8; ++i)
      {
        const std::string name = "b" + std::to_string(i);
        names += (names.empty() ? "" : ", ") + name;
        sections += box(name,
                        std::to_string(i % 2) + ", " + std::to_string(i / 2 % 2) + ", " +
                          (i / 4 ? "1.5" : "0.5"),
                        2);
      }
    std::vector<std::string> overrides = {"Time/End=0.05",
                                          "Obstacles/ground/Surfaces=b0:z-, b1:z-, b2:z-, b3:z-"};
    for (const char *const friction : {"0", "0.3"})
      {
        overrides.push_back(std::string("Contact/touch/Friction coefficient=") + friction);
        const auto run           = run_text(rubber_boxes + bodies(names, sections), overrides);
        const double penetration = largest_of(run.history["max_penetration_rel"]);
        report(std::string("friction ") + friction + ": penetration over h", penetration);
        report("  iterations a step", mean_iterations(run.history));
        EXPECT_LT(penetration, 1e-6);
        EXPECT_LT(largest_of(run.history["energy_error"]), 1e-3);
      }
  }


  // A stiff box slides over the rim of a soft one: nodes next to the rim and below the top are
  // beside the body, not in it.
  TEST(FlushBoxes, pass_the_rim_of_what_they_slide_on)
  {
    const auto run           = run_text(rubber_boxes + bodies("low, high",
                                                    box("low", "0, 0, 0.25", 4) +
                                                      box("high", "0.02, 0.01, 0.7501", 2)),
                              {"Time/End=0.2",
                                         "Materials/rubber/Density=10",
                                         "Materials/rubber/Young's modulus=1e5",
                                         "Materials/stiff/Young's modulus=1e8",
                                         "Bodies/low/Box/Size=1, 1, 0.5",
                                         "Bodies/low/Box/Cells=4, 4, 2",
                                         "Bodies/high/Material=stiff",
                                         "Bodies/high/Box/Size=0.8, 0.8, 0.5",
                                         "Bodies/high/Velocity=0.3, 0.2, -0.2",
                                         "Bodies/high/Rotation angle=13",
                                         "Obstacles/ground/Surfaces=low:z-",
                                         "Body force/Acceleration=0; 0; -0.5"});
    const double penetration = largest_of(run.history["max_penetration_rel"]);
    report("penetration over h", penetration);
    EXPECT_LT(penetration, 1e-6);
  }


  const std::string cylinders = contact + R"(
subsection Materials
  set Names = rubber
  subsection rubber
    set Density         = 1000
    set Young's modulus = 1e6
    set Poisson's ratio = 0.3
  end
end
subsection Bodies
  set Names = a, b
  subsection a
    set Material = rubber
    set Shape    = cylinder
    set Position = -0.22, 0, 0
    set Spin     = 0, 0, 60
    set Velocity = 1, 0, 0
    subsection Cylinder
      set Radius       = 0.2
      set Length       = 0.3
      set Cells across = 4
      set Cells radial = 2
      set Cells axial  = 4
    end
  end
  subsection b
    set Material = rubber
    set Shape    = cylinder
    set Position = 0.22, 0, 0.02
    set Spin     = 0, 0, 60
    set Velocity = -1, 0, 0
    subsection Cylinder
      set Radius       = 0.2
      set Length       = 0.25
      set Cells across = 6
      set Cells radial = 3
      set Cells axial  = 5
    end
  end
end
)";


  // The end of one is in the other's side: nodes far beyond its rim are not in the planes of its
  // faces.
  TEST(SpinningCylinders, touch_at_the_rim_of_one_and_part)
  {
    const auto run           = run_text(cylinders,
                              {"Time/End=0.3", "Contact/touch/Friction coefficient=0.5"});
    const double penetration = largest_of(run.history["max_penetration_rel"]);
    report("penetration over h", penetration);
    report("change of angular momentum", change_of_momentum(run.history, "angular_momentum_"));
    EXPECT_LT(penetration, 1e-5);
    EXPECT_LT(largest_of(run.history["energy_error"]), 1e-2);
    EXPECT_LT(change_of_momentum(run.history, "angular_momentum_"), 1e-10);
  }


  const std::string plate = contact + R"(
subsection Materials
  set Names = steel, hard
  subsection steel
    set Law               = j2
    set Density           = 7800
    set Young's modulus   = 2e11
    set Poisson's ratio   = 0.3
    set Yield stress      = 3e8
    set Hardening modulus = 1e9
  end
  subsection hard
    set Density         = 7800
    set Young's modulus = 2e11
    set Poisson's ratio = 0.3
  end
end
subsection Bodies
  set Names = plate, ball
  subsection plate
    set Material = steel
    set Shape    = box
    subsection Box
      set Size  = 0.1, 0.1, 0.002
      set Cells = 20, 20, 1
    end
  end
  subsection ball
    set Material = hard
    set Shape    = sphere
    set Position = 0.0013, 0.0007, 0.0111
    set Velocity = 0, 0, -200
    subsection Sphere
      set Radius       = 0.01
      set Cells across = 4
      set Cells radial = 3
    end
  end
end
subsection Prescribed motion
  set Names = clamp
  subsection clamp
    set Type     = displacement
    set Surfaces = plate:x-, plate:x+, plate:y-, plate:y+
  end
end
)";


  // A ball dents a plate one cell thick to less than half of its thickness: its two sides see each
  // other through the material, and do not touch.
  TEST(ThinPlate, is_not_in_contact_with_its_own_other_side)
  {
    const auto run = run_text(plate, {"Time/End=1e-4", "Contact/touch/Friction coefficient=0.1"});
    const double penetration = largest_of(run.history["max_penetration_rel"]);
    report("penetration over h", penetration);
    EXPECT_LT(penetration, 1e-6);
  }
} // namespace flush_bodies
