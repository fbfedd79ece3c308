#pragma once

#include <akmon/contact/search/box_grid.h>

#include <deal.II/base/mpi.h>

#include <vector>

namespace akmon
{
  /**
   * Where the ranks have what others may meet: boxes around points that follow each other. A rank
   * that is in several places is not taken to be in between.
   */
  class RankRegions
  {
  public:
    /// Points of this rank, in an order in which neighbours are mostly close to each other.
    void
    add(const dealii::Tensor<1, 3> &point, const unsigned int body);

    /// Let all ranks know, with a margin around the boxes (length; collective).
    void
    exchange(const double margin, const MPI_Comm communicator);

    /// The ranks whose boxes hold a point, valid until the next call.
    const std::vector<unsigned int> &
    at(const dealii::Tensor<1, 3> &x);

  private:
    struct Region
    {
      Box box;
      unsigned int rank;
    };

    std::vector<Region> regions; ///< of this rank, then of all
    unsigned int last_body = 0, n_in_last = 0;
    BoxGrid grid;
    std::vector<unsigned int> found, ranks; ///< scratch
  };
} // namespace akmon
