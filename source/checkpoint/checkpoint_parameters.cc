#include <akmon/checkpoint/checkpoint_parameters.h>

namespace akmon
{
  using dealii::Patterns::Double;
  using dealii::Patterns::Integer;

  void
  CheckpointParameters::declare(dealii::ParameterHandler &prm)
  {
    prm.declare_entry("Interval", "0", Double(0.), "Time between checkpoints (time; 0: none)");
    prm.declare_entry("Steps", "0", Integer(0), "Steps between checkpoints (0: none)");
    prm.declare_entry("Wall minutes",
                      "30",
                      Double(0.),
                      "Minutes of computing between checkpoints (0: none)");
  }


  void
  CheckpointParameters::parse(dealii::ParameterHandler &prm)
  {
    tick.interval = prm.get_double("Interval");
    tick.steps    = prm.get_integer("Steps");
    wall_minutes  = prm.get_double("Wall minutes");
  }
} // namespace akmon
