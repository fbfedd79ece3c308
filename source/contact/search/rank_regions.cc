#include <akmon/contact/coupled/gather.h>
#include <akmon/contact/search/rank_regions.h>

#include <utility>

namespace akmon
{
  using namespace dealii;

  void
  RankRegions::add(const Tensor<1, 3> &point, const unsigned int body)
  {
    constexpr unsigned int most_points = 32; // of a box; even, for the two ends of edges

    if (regions.empty() || body != last_body || n_in_last == most_points)
      {
        regions.push_back({{point, point}, 0});
        last_body = body;
        n_in_last = 0;
      }
    ++n_in_last;
    regions.back().box.include(point);
  }


  void
  RankRegions::exchange(const double margin, const MPI_Comm communicator)
  {
    for (auto &region : regions)
      {
        region.rank = Utilities::MPI::this_mpi_process(communicator);
        region.box.widen(margin);
      }
    regions = gather(regions, communicator);
    std::vector<Box> boxes;
    for (const auto &region : regions)
      boxes.push_back(region.box);
    grid.reinit(std::move(boxes));
  }


  const std::vector<unsigned int> &
  RankRegions::at(const Tensor<1, 3> &x)
  {
    found.clear();
    ranks.clear();
    grid.collect(x, found);
    for (const unsigned int number : found) // in rising order, as the ranks are
      if (ranks.empty() || ranks.back() != regions[number].rank)
        ranks.push_back(regions[number].rank);
    return ranks;
  }
} // namespace akmon
