#include <akmon/output/stage_timer.h>

#include <algorithm>
#include <limits>

namespace akmon
{
  StageTimer::Stage
  StageTimer::add(const std::string &name)
  {
    const auto known = std::find_if(records.begin(), records.end(), [&name](const Record &record) {
      return record.name == name;
    });
    const auto index = static_cast<std::size_t>(known - records.begin());
    if (known == records.end())
      {
        records.emplace_back();
        records.back().name = name;
      }
    return Stage(*this, index);
  }


  std::vector<StageTimer::Total>
  StageTimer::totals() const
  {
    return totals(MPI_COMM_SELF);
  }


  std::vector<StageTimer::Total>
  StageTimer::totals(const MPI_Comm comm) const
  {
    constexpr unsigned int unused = std::numeric_limits<unsigned int>::max();

    std::vector<double> seconds;
    std::vector<unsigned long> calls;
    std::vector<unsigned int> first_use;
    for (const auto &record : records)
      {
        seconds.push_back(std::chrono::duration<double>(record.duration).count());
        calls.push_back(record.calls);
        first_use.push_back(record.first_use == 0 ? unused : record.first_use);
      }
    std::vector<double> sums(seconds.size());
    dealii::Utilities::MPI::sum(seconds, comm, sums);
    dealii::Utilities::MPI::max(seconds, comm, seconds);
    const double n_ranks = dealii::Utilities::MPI::n_mpi_processes(comm);
    dealii::Utilities::MPI::max(calls, comm, calls);
    dealii::Utilities::MPI::min(first_use, comm, first_use);

    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < records.size(); ++i)
      if (first_use[i] != unused)
        order.push_back(i);
    // Ranks may disagree on who came first; a stable sort then falls back on the registration.
    std::stable_sort(order.begin(), order.end(), [&](const std::size_t a, const std::size_t b) {
      return first_use[a] < first_use[b];
    });

    std::vector<Total> result;
    for (const auto i : order)
      result.push_back({records[i].name,
                        seconds[i],
                        calls[i],
                        sums[i] > 0. ? n_ranks * seconds[i] / sums[i] : 1.});
    return result;
  }
} // namespace akmon
