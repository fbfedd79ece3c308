#include <akmon/contact/bonds/bond_points.h>
#include <akmon/contact/search/face_geometry.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace akmon
{
  using namespace dealii;

  namespace
  {
    using Place   = std::array<double, 2>;
    using Polygon = std::vector<Place>;


    double
    cross(const Place &a, const Place &b, const Place &c)
    {
      return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    }


    double
    area(const Polygon &polygon)
    {
      double sum = 0.;
      for (std::size_t i = 1; i + 1 < polygon.size(); ++i)
        sum += 0.5 * cross(polygon[0], polygon[i], polygon[i + 1]);
      return sum;
    }


    // What of a polygon lies in a convex one (Sutherland and Hodgman), both counter-clockwise.
    Polygon
    clip(Polygon subject, const Polygon &by)
    {
      for (std::size_t e = 0; e < by.size() && !subject.empty(); ++e)
        {
          const Place &a = by[e], &b = by[(e + 1) % by.size()];
          Polygon inside;
          for (std::size_t i = 0; i < subject.size(); ++i)
            {
              const Place &p = subject[i], &q = subject[(i + 1) % subject.size()];
              const double d_p = cross(a, b, p), d_q = cross(a, b, q);
              if (d_p >= 0.)
                inside.push_back(p);
              if ((d_p >= 0.) != (d_q >= 0.))
                {
                  const double s = d_p / (d_p - d_q);
                  inside.push_back({{p[0] + s * (q[0] - p[0]), p[1] + s * (q[1] - p[1])}});
                }
            }
          subject = std::move(inside);
        }
      return subject;
    }


    // The mean plane of a face, for clipping.
    struct Plane
    {
      explicit Plane(const Segment &corners)
        : origin(middle_of(corners))
        , normal(area_vector(corners))
      {
        normal /= normal.norm();
        first = corners[1] + corners[2] - corners[0] - corners[3];
        first -= (normal * first) * normal;
        first /= first.norm();
        second = cross_product_3d(normal, first);
      }

      Place
      project(const Tensor<1, 3> &x) const
      {
        return {{first * (x - origin), second * (x - origin)}};
      }

      Tensor<1, 3>
      in_space(const Place &place) const
      {
        return origin + place[0] * first + place[1] * second;
      }

      Tensor<1, 3> origin, normal, first, second;
    };


    Tensor<1, 3>
    interpolate(const Segment &corners, const std::array<double, 4> &N)
    {
      return N[0] * corners[0] + N[1] * corners[1] + N[2] * corners[2] + N[3] * corners[3];
    }


    // The quarter of a face next to its corner k, in the plane.
    Polygon
    quarter(const Segment &corners, const unsigned int k, const Plane &plane)
    {
      const auto &a = corners[k], &b = corners[(k + 1) % 4], &d = corners[(k + 3) % 4];
      const auto middle = middle_of(corners);
      return {plane.project(a),
              plane.project(0.5 * (a + b)),
              plane.project(middle),
              plane.project(0.5 * (a + d))};
    }


    // Points of a bond as they are summed up.
    struct Sum
    {
      double area = 0.;
      std::map<types::global_dof_index, double> row;
      std::set<unsigned int> faces;
    };


    // Adds what of a slave face's quarters lies on a master face.
    class Overlap
    {
    public:
      Overlap(const std::vector<TiedFace> &slaves,
              const unsigned int face,
              const double distance,
              std::map<types::global_dof_index, Sum> &sums)
        : slave(slaves[face])
        , face(face)
        , plane(slave.corners)
        , size(std::sqrt(area_vector(slave.corners).norm()))
        , distance(distance * size)
        , sums(sums)
      {
      }

      void
      add(const TiedFace &master)
      {
        constexpr double opposed = -0.5; // cosine

        const auto normal = area_vector(master.corners);
        if (normal * plane.normal > opposed * normal.norm() || is_far(master))
          return;
        Polygon by;
        for (unsigned int k = 4; k-- > 0;) // seen from the other side
          by.push_back(plane.project(master.corners[k]));
        for (unsigned int k = 0; k < 4; ++k)
          {
            const Polygon part = clip(quarter(slave.corners, k, plane), by);
            if (part.size() >= 3 && area(part) > 1e-9 * size * size)
              integrate(master, part, sums[slave.nodes[k]]);
          }
      }

    private:
      bool
      is_far(const TiedFace &master) const
      {
        for (unsigned int d = 0; d < 3; ++d)
          {
            double low = slave.corners[0][d], high = low, master_low = master.corners[0][d],
                   master_high = master_low;
            for (unsigned int k = 1; k < 4; ++k)
              {
                low         = std::min(low, slave.corners[k][d]);
                high        = std::max(high, slave.corners[k][d]);
                master_low  = std::min(master_low, master.corners[k][d]);
                master_high = std::max(master_high, master.corners[k][d]);
              }
            if (master_low > high + distance || master_high < low - distance)
              return true;
          }
        return false;
      }


      // Over triangles, by the midpoints of their edges: exact for shape functions on
      // parallelograms.
      void
      integrate(const TiedFace &master, const Polygon &part, Sum &sum)
      {
        for (std::size_t i = 1; i + 1 < part.size(); ++i)
          {
            const std::array<Place, 3> corners = {{part[0], part[i], part[i + 1]}};
            const double weight                = cross(corners[0], corners[1], corners[2]) / 6.;
            for (unsigned int e = 0; e < 3; ++e)
              {
                const Place &p = corners[e], &q = corners[(e + 1) % 3];
                const auto on_slave  = project(plane.in_space(
                                                {{0.5 * (p[0] + q[0]), 0.5 * (p[1] + q[1])}}),
                                              slave.corners,
                                              0.);
                const auto place     = interpolate(slave.corners, on_slave.N);
                const auto on_master = project(place, master.corners, 0.);
                if (!(on_master.offset.norm() <= distance))
                  continue;
                sum.area += weight;
                sum.faces.insert(face);
                for (unsigned int k = 0; k < 4; ++k)
                  {
                    sum.row[slave.nodes[k]] += weight * on_slave.N[k];
                    sum.row[master.nodes[k]] -= weight * on_master.N[k];
                  }
              }
          }
      }

      const TiedFace &slave;
      const unsigned int face;
      const Plane plane;
      const double size, distance;
      std::map<types::global_dof_index, Sum> &sums;
    };
  } // namespace


  std::vector<TiedFace>
  tied_faces(const Discretization &discretization,
             const std::string &section,
             const std::string &key,
             const std::vector<std::string> &surfaces)
  {
    constexpr unsigned int width = 17; // id, nodes, corners
    std::vector<double> here;
    for (const auto &face :
         discretization.faces_on(discretization.boundary_ids(section, key, surfaces)))
      if (face.owned)
        {
          here.push_back(face.id);
          for (const unsigned int node : face.nodes)
            here.push_back(discretization.global_node(node));
          for (const unsigned int node : face.nodes)
            for (unsigned int d = 0; d < 3; ++d)
              here.push_back(discretization.reference.local_element(3 * node + d));
        }
    std::vector<std::array<double, width>> rows;
    for (const auto &of_rank : Utilities::MPI::all_gather(discretization.communicator(), here))
      for (std::size_t i = 0; i < of_rank.size(); i += width)
        {
          rows.emplace_back();
          std::copy_n(of_rank.begin() + i, width, rows.back().begin());
        }
    std::sort(rows.begin(), rows.end());
    std::vector<TiedFace> faces;
    for (const auto &row : rows)
      {
        faces.emplace_back();
        for (unsigned int k = 0; k < 4; ++k)
          {
            faces.back().nodes[k] = row[1 + k];
            for (unsigned int d = 0; d < 3; ++d)
              faces.back().corners[k][d] = row[5 + 3 * k + d];
          }
      }
    return faces;
  }


  std::vector<BondPoint>
  bond_points(const std::vector<TiedFace> &slaves,
              const std::vector<TiedFace> &masters,
              const double distance)
  {
    constexpr double sliver = 1e-6; // of the largest point: not worth a constraint

    std::map<types::global_dof_index, Sum> sums;
    for (unsigned int f = 0; f < slaves.size(); ++f)
      {
        Overlap overlap(slaves, f, distance, sums);
        for (const auto &master : masters)
          overlap.add(master);
      }
    double largest = 0.;
    for (const auto &[node, sum] : sums)
      largest = std::max(largest, sum.area);
    std::vector<BondPoint> points;
    for (const auto &[node, sum] : sums)
      if (sum.area > sliver * largest)
        {
          BondPoint point;
          point.slave = node;
          point.area  = sum.area;
          for (const auto &[of, weight] : sum.row)
            if (weight != 0.)
              point.row.emplace_back(of, weight / sum.area);
          point.faces.assign(sum.faces.begin(), sum.faces.end());
          points.push_back(std::move(point));
        }
    return points;
  }
} // namespace akmon
