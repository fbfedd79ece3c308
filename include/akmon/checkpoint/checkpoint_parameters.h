#pragma once

#include <akmon/output/output_parameters.h>

#include <deal.II/base/parameter_handler.h>

namespace akmon
{
  /// When checkpoints are written. Section "Checkpoint".
  struct CheckpointParameters
  {
    OutputTick tick;
    double wall_minutes = 30.; ///< between checkpoints; zero: not by wall time

    static void
    declare(dealii::ParameterHandler &prm);

    void
    parse(dealii::ParameterHandler &prm);
  };
} // namespace akmon
