#pragma once

#include <string>
#include <vector>

namespace akmon
{
  /// What a run is started from.
  struct Restart
  {
    std::string file; ///< parameter file
    std::vector<std::string> overrides;
    std::string checkpoint; ///< to go on from; empty: from the beginning
  };

  /**
   * How to go on with an earlier run: the parameters it used and its newest checkpoint, or the one
   * named. Throws InputError if there is none.
   * @param place      output directory of the run, or a checkpoint in it
   * @param overrides  what is to change from the checkpoint on
   */
  Restart
  find_restart(const std::string &place, std::vector<std::string> overrides);
} // namespace akmon
