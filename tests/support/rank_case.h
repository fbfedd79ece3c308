#pragma once

#include <ostream>

#include "support/run_directory.h"

namespace akmon::test
{
  /// A shipped case, varied, to be run on several numbers of ranks.
  struct RankCase
  {
    std::string name;
    std::vector<std::string> overrides;
  };


  inline void
  PrintTo(const RankCase &rank_case, std::ostream *out)
  {
    *out << rank_case.name;
  }


  /**
   * Expect one hash of the final state on 1, 2, ... ranks.
   * @param overrides  besides those of the case
   * @param look_at    look_at(directory) of the run on one rank
   */
  template <typename LookAt>
  void
  expect_one_hash(const RankCase &rank_case,
                  const unsigned int most_ranks,
                  const std::vector<std::string> &overrides,
                  const LookAt &look_at)
  {
    std::string hash;
    for (unsigned int n_ranks = 1; n_ranks <= most_ranks; ++n_ranks)
      {
        const ScratchDirectory scratch;
        auto all = rank_case.overrides;
        all.insert(all.end(), overrides.begin(), overrides.end());
        const auto result = run_program(arguments_for(shipped(rank_case.name), scratch.path, all),
                                        n_ranks);
        ASSERT_EQ(result.status, 0) << result.output;
        if (n_ranks == 1)
          {
            hash = summary_value(scratch.path, "state_hash");
            look_at(scratch.path);
          }
        EXPECT_EQ(summary_value(scratch.path, "state_hash"), hash) << n_ranks << " ranks";
      }
  }
} // namespace akmon::test
