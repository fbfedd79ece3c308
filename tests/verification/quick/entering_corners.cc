#include <gtest/gtest.h>

#include "support/kept_run.h"
#include "support/report.h"

// Corners that come over the rims of other bodies from beside, or are bent so far that their mean
// normals no longer tell what they look at, in steps of up to a fifth of a cell. There is no exact
// answer but that nothing may be inside anything. Motions are chaotic: where places are changed by
// 1e-9 of a body or the processor is another, the largest penetration is anything up to 2e-3.

namespace entering_corners
{
  using namespace akmon::test;

  const std::string poured_boxes = R"(
subsection Time
  set End = 0.15
end
subsection Materials
  set Names = rubber
  subsection rubber
    set Density         = 1100
    set Young's modulus = 1e5
    set Poisson's ratio = 0.4
  end
end
subsection Bodies
  set Names = box
  subsection box
    set Material = rubber
    set Shape    = box
    set Position = -0.026, -0.026, 0.018
    set Velocity = 0, 0, -0.5
    subsection Copies
      set Count   = 3, 3, 3
      set Spacing = 0.026, 0.026, 0.028
      set Jitter  = 0.001
      set Turn    = true
    end
    subsection Box
      set Size = 0.014, 0.014, 0.014
      set Cells = 3, 3, 3
    end
  end
end
subsection Contact
  set Names = boxes
  subsection boxes
    set Slave                = all
    set Master               = all
    set Friction coefficient = 0.3
  end
end
subsection Obstacles
  set Names = floor, left, right, front, back
  subsection floor
    set Surfaces             = all
    set Friction coefficient = 0.3
  end
  subsection left
    set Surfaces = all
    set Point    = -0.04, 0, 0
    set Normal   = 1, 0, 0
  end
  subsection right
    set Surfaces = all
    set Point    = 0.04, 0, 0
    set Normal   = -1, 0, 0
  end
  subsection front
    set Surfaces = all
    set Point    = 0, -0.04, 0
    set Normal   = 0, 1, 0
  end
  subsection back
    set Surfaces = all
    set Point    = 0, 0.04, 0
    set Normal   = 0, -1, 0
  end
end
subsection Body force
  set Acceleration = 0; 0; -9.81
end
)";


  const std::string shaft_and_bushing = R"(
subsection Time
  set End = 0.03
end
subsection Materials
  set Names = rubber
  subsection rubber
    set Density         = 1000
    set Young's modulus = 1e6
    set Poisson's ratio = 0.3
  end
end
subsection Bodies
  set Names = shaft, bushing
  subsection shaft
    set Material = rubber
    set Shape    = cylinder
    set Position = 0.005, 0.002, 0.21
    set Velocity = 0, 0, -10
    subsection Cylinder
      set Radius       = 0.098
      set Length       = 0.3
      set Cells across = 4
      set Cells radial = 2
      set Cells axial  = 6
    end
  end
  subsection bushing
    set Material = rubber
    set Shape    = hollow cylinder
    subsection Hollow cylinder
      set Inner radius = 0.1
      set Outer radius = 0.16
      set Length       = 0.2
      set Cells around = 24
      set Cells radial = 2
      set Cells axial  = 4
    end
  end
end
subsection Contact
  set Names = touch
  subsection touch
    set Slave                = all
    set Master               = all
    set Friction coefficient = 0.2
  end
end
)";


  double
  largest_penetration(const std::string &text, const std::vector<std::string> &overrides)
  {
    const auto run           = run_text(text, overrides);
    const double penetration = largest_of(run.history["max_penetration_rel"]);
    report("penetration over h", penetration);
    report("  iterations a step", mean_iterations(run.history));
    EXPECT_LT(largest_of(run.history["energy_error"]), 1e-2);
    EXPECT_LT(mean_iterations(run.history), 300.);
    return penetration;
  }


  // Lost contact at .045 (.26 of a cell) while nodes without a partner were not followed.
  TEST(PouredBoxes, keep_out_of_each_other)
  {
    for (const std::string friction : {"0.3", "0"})
      EXPECT_LT(largest_penetration(poured_boxes,
                                    {"Time/End=0.06",
                                     "Contact/boxes/Friction coefficient=" + friction}),
                1e-2);
  }


  // The rim of the shaft folds up on the rim of the bushing and slips over it. Lost contact at .01
  // (.33 of a cell) when the folded corners were no longer taken to look at what they stood on.
  TEST(Shaft, slips_into_a_bushing_that_is_too_narrow)
  {
    EXPECT_LT(largest_penetration(shaft_and_bushing, {}), 1e-2);
  }
} // namespace entering_corners
