#include <akmon/contact/search/box.h>
#include <akmon/contact/search/face_geometry.h>
#include <akmon/contact/search/initial_overlap.h>
#include <akmon/model/hexahedron_cell.h>
#include <akmon/output/history.h>
#include <akmon/parameters.h>

#include <deal.II/base/bounding_box.h>
#include <deal.II/base/geometry_info.h>
#include <deal.II/base/mpi.h>
#include <deal.II/fe/mapping_q1.h>
#include <deal.II/numerics/rtree.h>

#include <boost/iterator/function_output_iterator.hpp>

#include <algorithm>
#include <limits>
#include <tuple>

namespace akmon
{
  using namespace dealii;

  namespace
  {
    using CellIterator = Triangulation<3>::cell_iterator;

    // Rounding of coordinates, relative to the shortest edge of a cell.
    constexpr double tolerated = 1e-6;


    template <typename Corners>
    Box
    box_of(const Corners &corners)
    {
      Box box;
      for (const auto &corner : corners)
        box.include(corner);
      return box;
    }


    BoundingBox<3>
    bounding_box(const Box &box)
    {
      return BoundingBox<3>({Point<3>(box.lower), Point<3>(box.upper)});
    }


    // A place of a body, and the body it was found in.
    struct Sample
    {
      Point<3> place;
      unsigned int inside, outside;
      double tolerance = 0.; // of the depth; length

      template <class Archive>
      void
      serialize(Archive &archive, const unsigned int)
      {
        archive &place &inside &outside &tolerance;
      }
    };


    // The boxes of the bodies, on every rank and altogether.
    class BodyBoxes
    {
    public:
      explicit BodyBoxes(const Discretization &discretization)
      {
        std::vector<Box> own(discretization.get_bodies().size());
        for (const auto &cell : discretization.cells)
          if (cell.owned)
            own[cell.body].include(box_of(discretization.corners_of(cell)));
        of_ranks = Utilities::MPI::all_gather(discretization.communicator(), own);
        whole.resize(own.size());
        for (const auto &of_rank : of_ranks)
          for (unsigned int body = 0; body < whole.size(); ++body)
            whole[body].include(of_rank[body]);
        partners.resize(own.size());
        for (unsigned int a = 0; a < whole.size(); ++a)
          for (unsigned int b = 0; b < whole.size(); ++b)
            if (a != b && whole[a].meets(whole[b]))
              partners[a].push_back(b);
      }

      std::vector<std::vector<Box>> of_ranks;          // [rank][body]
      std::vector<Box> whole;                          // [body]
      std::vector<std::vector<unsigned int>> partners; // [body]: bodies whose boxes meet its box
    };


    // Places on and right below a boundary face of a cell.
    std::array<Point<3>, 10>
    places_at(const CellIterator &cell, const unsigned int f)
    {
      const auto face = cell->face(f);
      std::array<Point<3>, 10> places;
      for (unsigned int k = 0; k < 4; ++k)
        {
          places[k]     = face->vertex(k);
          places[4 + k] = face->line(k)->center();
        }
      places[8] = face->center();
      places[9] = cell->center();
      return places;
    }


    // The places of all bodies that may lie in a cell of another body on this rank.
    std::vector<Sample>
    samples_for_this_rank(const Discretization &discretization, const BodyBoxes &boxes)
    {
      const MPI_Comm communicator = discretization.communicator();
      const unsigned int me       = Utilities::MPI::this_mpi_process(communicator);
      std::map<unsigned int, std::vector<Sample>> outgoing;
      HexahedronCell hexahedron;
      for (const auto &face : discretization.boundary_faces())
        if (face.owned && !boxes.partners[face.body].empty())
          for (const auto &place :
               places_at(hexahedron.at(discretization.corners_of(discretization.cells[face.cell])),
                         face.id % 6))
            for (const unsigned int partner : boxes.partners[face.body])
              if (boxes.whole[partner].holds(place))
                for (unsigned int rank = 0; rank < boxes.of_ranks.size(); ++rank)
                  if (boxes.of_ranks[rank][partner].holds(place))
                    outgoing[rank].push_back({place, face.body, partner, 0.});
      std::vector<Sample> samples = std::move(outgoing[me]);
      outgoing.erase(me);
      for (const auto &[rank, received] : Utilities::MPI::some_to_some(communicator, outgoing))
        samples.insert(samples.end(), received.begin(), received.end());
      return samples;
    }


    // Whether a place lies in a cell; coordinates of the reference cell are exact to round-off.
    bool
    lies_in(const Point<3> &place, const CellIterator &cell)
    {
      try
        {
          const auto reference = StaticMappingQ1<3>::mapping.transform_real_to_unit_cell(cell,
                                                                                         place);
          return GeometryInfo<3>::is_inside_unit_cell(reference, 1e-9);
        }
      catch (const Mapping<3>::ExcTransformationFailed &)
        {
          return false; // so far outside that the map has no inverse there
        }
    }


    // The boundary of the bodies, as far as this rank knows it.
    class Boundaries
    {
    public:
      Boundaries(const Discretization &discretization, const BodyBoxes &boxes)
        : faces(boxes.whole.size())
        , trees(boxes.whole.size())
      {
        std::vector<std::vector<std::pair<BoundingBox<3>, unsigned int>>> entries(faces.size());
        for (const auto &face : discretization.boundary_faces())
          if (!boxes.partners[face.body].empty())
            {
              const Segment corners = segment_of(face, discretization.reference);
              entries[face.body].emplace_back(bounding_box(box_of(corners)),
                                              faces[face.body].size());
              faces[face.body].push_back(corners);
            }
        for (unsigned int body = 0; body < faces.size(); ++body)
          trees[body] = pack_rtree(entries[body]);
      }

      // To the closest known boundary face of a body: the face in the closest box is near it, and
      // whatever is nearer still has its box within that distance.
      double
      distance(const Point<3> &place, const unsigned int body) const
      {
        double best        = std::numeric_limits<double>::max();
        const auto measure = [&](const auto &entry) {
          best = std::min(best, project(place, faces[body][entry.second], 0.).offset.norm());
        };
        trees[body].query(boost::geometry::index::nearest(place, 1),
                          boost::make_function_output_iterator(measure));
        if (trees[body].empty())
          return best;
        BoundingBox<3> around({place, place});
        around.extend(best);
        trees[body].query(boost::geometry::index::intersects(around),
                          boost::make_function_output_iterator(measure));
        return best;
      }

    private:
      std::vector<std::vector<Segment>> faces; // [body]
      std::vector<RTree<std::pair<BoundingBox<3>, unsigned int>>> trees;
    };


    // Those samples that are inside cells of this rank, by more than what is tolerated as far as
    // this rank can tell.
    std::vector<Sample>
    samples_inside(const Discretization &discretization,
                   const BodyBoxes &boxes,
                   const Boundaries &boundaries,
                   std::vector<Sample> samples)
    {
      std::vector<std::pair<BoundingBox<3>, unsigned int>> entries;
      for (unsigned int c = 0; c < discretization.cells.size(); ++c)
        {
          const auto &cell   = discretization.cells[c];
          const auto &others = boxes.partners[cell.body];
          const Box box      = box_of(discretization.corners_of(cell));
          if (cell.owned &&
              std::any_of(others.begin(), others.end(), [&](const unsigned int other) {
                return box.meets(boxes.whole[other]);
              }))
            entries.emplace_back(bounding_box(box), c);
        }
      const auto tree = pack_rtree(entries);

      HexahedronCell hexahedron;
      std::vector<Sample> found;
      for (auto &sample : samples)
        {
          bool inside = false;
          tree.query(boost::geometry::index::intersects(sample.place),
                     boost::make_function_output_iterator([&](const auto &entry) {
                       const auto &relevant = discretization.cells[entry.second];
                       const auto cell      = hexahedron.at(discretization.corners_of(relevant));
                       if (!inside && relevant.body == sample.outside &&
                           lies_in(sample.place, cell))
                         {
                           inside           = true;
                           sample.tolerance = tolerated * cell->minimum_vertex_distance();
                         }
                     }));
          if (inside && boundaries.distance(sample.place, sample.outside) > sample.tolerance)
            found.push_back(sample);
        }
      return found;
    }
  } // namespace


  std::optional<BodyOverlap>
  find_deepest_overlap(const Discretization &discretization)
  {
    const MPI_Comm communicator = discretization.communicator();
    const BodyBoxes boxes(discretization);
    if (std::all_of(boxes.partners.begin(), boxes.partners.end(), [](const auto &partners) {
          return partners.empty();
        }))
      return {};
    const Boundaries boundaries(discretization, boxes);
    const auto found = samples_inside(discretization,
                                      boxes,
                                      boundaries,
                                      samples_for_this_rank(discretization, boxes));

    // The closest boundary face may be another rank's: all ranks measure all samples.
    std::vector<Sample> all;
    for (const auto &of_rank : Utilities::MPI::all_gather(communicator, found))
      all.insert(all.end(), of_rank.begin(), of_rank.end());
    std::vector<double> depths;
    depths.reserve(all.size());
    for (const auto &sample : all)
      depths.push_back(boundaries.distance(sample.place, sample.outside));
    Utilities::MPI::min(depths, communicator, depths);

    // Among equally deep places the first in space, so that the number of ranks does not matter.
    std::optional<BodyOverlap> deepest;
    const auto before = [](const BodyOverlap &a, const BodyOverlap &b) {
      return std::make_tuple(-a.depth, a.inside, a.outside, a.place[0], a.place[1], a.place[2]) <
             std::make_tuple(-b.depth, b.inside, b.outside, b.place[0], b.place[1], b.place[2]);
    };
    for (unsigned int i = 0; i < all.size(); ++i)
      {
        const BodyOverlap overlap{all[i].inside, all[i].outside, all[i].place, depths[i]};
        if (depths[i] > all[i].tolerance && (!deepest || before(overlap, *deepest)))
          deepest = overlap;
      }
    return deepest;
  }


  void
  refuse_body_overlap(const Discretization &discretization)
  {
    const auto overlap = find_deepest_overlap(discretization);
    if (!overlap)
      return;
    const std::string inside  = discretization.get_bodies()[overlap->inside].name,
                      outside = discretization.get_bodies()[overlap->outside].name;
    throw InputError("[Bodies] '" + inside + "' and '" + outside + "' overlap at the start: '" +
                     inside + "' is " + rounded_text(overlap->depth) + " deep inside '" + outside +
                     "' at " + place_text(overlap->place) + "; move the bodies apart");
  }
} // namespace akmon
