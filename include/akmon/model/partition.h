#pragma once

#include <deal.II/base/parameter_handler.h>
#include <deal.II/base/types.h>

#include <map>
#include <string>

namespace akmon
{
  /// What cells cost besides their own forces, for the partition: thousandths of the latter, by
  /// cell id (RelevantCell::id).
  using ExtraWork = std::map<dealii::types::global_cell_index, unsigned int>;


  /// How cells are shared out to ranks. Section "Parallel".
  struct PartitionParameters
  {
    double repartition_above = 1.2; ///< work of the busiest rank over the mean one

    static void
    declare(dealii::ParameterHandler &prm)
    {
      prm
        .declare_entry("Repartition above",
                       "1.2",
                       dealii::Patterns::Double(1.),
                       "Work of the busiest rank over that of the mean one since the last "
                       "checkpoint above which the run goes on from a checkpoint with cells shared "
                       "out anew, those in contact counting more");
    }

    void
    parse(dealii::ParameterHandler &prm)
    {
      repartition_above = prm.get_double("Repartition above");
    }
  };


  /// Where and how a run goes on after cells have been shared out anew.
  struct Continuation
  {
    std::string checkpoint; ///< empty: the run is done
    ExtraWork extra_work;
    unsigned int n_repartitions = 0; ///< so far
  };
} // namespace akmon
