#include <akmon/rigid/triangle_shape.h>

#include <boost/geometry/geometries/box.hpp>
#include <boost/geometry/geometries/point.hpp>
#include <boost/geometry/index/rtree.hpp>
#include <boost/geometry/strategies/strategies.hpp>
#include <boost/iterator/function_output_iterator.hpp>

#include <algorithm>
#include <cmath>
#include <map>

namespace akmon
{
  using namespace dealii;
  namespace bg  = boost::geometry;
  namespace bgi = boost::geometry::index;

  namespace
  {
    using TreePoint = bg::model::point<double, 3, bg::cs::cartesian>;
    using TreeBox   = bg::model::box<TreePoint>;

    TreePoint
    tree_point(const Tensor<1, 3> &x, const double shift = 0.)
    {
      return TreePoint(x[0] + shift, x[1] + shift, x[2] + shift);
    }


    constexpr double coincident = 1e-12; // points closer than this, over the size of the shape


    double
    angle_between(const Tensor<1, 3> &a, const Tensor<1, 3> &b)
    {
      return std::atan2(cross_product_3d(a, b).norm(), a * b);
    }
  } // namespace


  struct TriangleShape::Tree
  {
    using Entry = std::pair<TreeBox, unsigned int>;
    bgi::rtree<Entry, bgi::rstar<16>> boxes;
  };


  TrianglePoint
  closest_on_triangle(const Tensor<1, 3> &x,
                      const Tensor<1, 3> &a,
                      const Tensor<1, 3> &b,
                      const Tensor<1, 3> &c)
  {
    constexpr double pi = numbers::PI;
    const auto ab = b - a, ac = c - a, bc = c - b;
    const auto ax = x - a, bx = x - b, cx = x - c;
    const double d1 = ab * ax, d2 = ac * ax;
    if (d1 <= 0. && d2 <= 0.)
      return {a, angle_between(ab, ac), false};
    const double d3 = ab * bx, d4 = ac * bx;
    if (d3 >= 0. && d4 <= d3)
      return {b, angle_between(-ab, bc), false};
    const double d5 = ab * cx, d6 = ac * cx;
    if (d6 >= 0. && d5 <= d6)
      return {c, angle_between(-ac, -bc), false};
    const double vc = d1 * d4 - d3 * d2;
    if (vc <= 0. && d1 >= 0. && d3 <= 0.)
      return {a + (d1 / (d1 - d3)) * ab, pi, false};
    const double vb = d5 * d2 - d1 * d6;
    if (vb <= 0. && d2 >= 0. && d6 <= 0.)
      return {a + (d2 / (d2 - d6)) * ac, pi, false};
    const double va = d3 * d6 - d5 * d4;
    if (va <= 0. && d4 - d3 >= 0. && d5 - d6 >= 0.)
      return {b + ((d4 - d3) / ((d4 - d3) + (d5 - d6))) * bc, pi, false};
    const double sum = va + vb + vc;
    return {a + (vb / sum) * ab + (vc / sum) * ac, 2. * pi, true};
  }


  TriangleShape::TriangleShape(TriangleMesh surface)
    : mesh(std::move(surface))
    , tree(std::make_unique<Tree>())
  {
    for (const auto &x : mesh.vertices)
      furthest = std::max(furthest, x.norm());
    for (const auto &x : mesh.vertices)
      size = std::max(size, 2. * (x - mesh.vertices[0]).norm());
    std::vector<Tree::Entry> entries;
    for (unsigned int i = 0; i < mesh.triangles.size(); ++i)
      {
        if (!has_direction(mesh.normal(mesh.triangles[i])))
          continue; // no direction; its neighbours cover it
        TreeBox box;
        bg::assign_inverse(box);
        for (const unsigned int v : mesh.triangles[i])
          bg::expand(box, tree_point(mesh.vertices[v]));
        entries.emplace_back(box, i);
      }
    tree->boxes = bgi::rtree<Tree::Entry, bgi::rstar<16>>(entries);
    find_sharp_edges();
  }


  TriangleShape::~TriangleShape() = default;


  // Convex edges whose triangles are turned against each other by more than a degree.
  void
  TriangleShape::find_sharp_edges()
  {
    constexpr double flat = 0.9998;
    struct Side
    {
      Tensor<1, 3> normal;
      unsigned int opposite;
    };
    std::map<std::array<unsigned int, 2>, Side> first_sides;
    for (const auto &t : mesh.triangles)
      {
        const auto n = mesh.normal(t);
        if (!has_direction(n))
          continue;
        for (unsigned int k = 0; k < 3; ++k)
          {
            const std::array<unsigned int, 2> edge = {
              {std::min(t[k], t[(k + 1) % 3]), std::max(t[k], t[(k + 1) % 3])}};
            const Side side{n / n.norm(), t[(k + 2) % 3]};
            const auto known = first_sides.emplace(edge, side);
            if (known.second)
              continue;
            const Side &other = known.first->second;
            const auto across = mesh.vertices[side.opposite] - mesh.vertices[edge[0]];
            if (other.normal * side.normal < flat && other.normal * across < 0.)
              sharp_edges.push_back({edge, {{other.normal, side.normal}}});
          }
      }
  }


  TrianglePoint
  TriangleShape::on_triangle(const Tensor<1, 3> &x, const unsigned int triangle) const
  {
    const auto &t = mesh.triangles[triangle];
    return closest_on_triangle(x, mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]);
  }


  void
  TriangleShape::collect(const Tensor<1, 3> &x, const double within, Neighbours &neighbours) const
  {
    neighbours.clear();
    const TreeBox box(tree_point(x, -within), tree_point(x, within));
    tree->boxes.query(bgi::intersects(box),
                      boost::make_function_output_iterator([&](const Tree::Entry &entry) {
                        neighbours.push_back({entry.second, on_triangle(x, entry.second)});
                      }));
    std::sort(neighbours.begin(), neighbours.end(), [](const Near &a, const Near &b) {
      return a.triangle < b.triangle;
    });
  }


  // The distance of the triangle with the closest box, and enough for all that meet at the closest
  // point.
  double
  TriangleShape::bound_of_distance(const Tensor<1, 3> &x) const
  {
    Tree::Entry first;
    tree->boxes.query(bgi::nearest(tree_point(x), 1), &first);
    return (x - on_triangle(x, first.second).point).norm() + 2. * coincident * size;
  }


  SurfacePoint
  TriangleShape::closest(const Tensor<1, 3> &x) const
  {
    Neighbours neighbours;
    collect(x, bound_of_distance(x), neighbours);
    return closest_among(x, neighbours);
  }


  SurfacePoint
  TriangleShape::closest_among(const Tensor<1, 3> &x, const Neighbours &neighbours) const
  {
    Tensor<1, 3> best;
    double least = std::numeric_limits<double>::max();
    for (const auto &near : neighbours)
      {
        const double distance = (x - near.at.point).norm();
        if (distance < least)
          {
            least = distance;
            best  = near.at.point;
          }
      }
    Tensor<1, 3> normal;
    for (const auto &near : neighbours)
      if ((near.at.point - best).norm() <= coincident * size)
        {
          const auto n = mesh.normal(mesh.triangles[near.triangle]);
          normal += (near.at.angle / n.norm()) * n;
        }
    normal /= normal.norm();
    const double side = (x - best) * normal < 0. ? -1. : 1.;
    // Too close for a direction of its own.
    if (least <= 1e-9 * size)
      return {(x - best) * normal, normal};
    return {side * least, (side / least) * (x - best)};
  }


  void
  TriangleShape::nearby_from(const double side,
                             const Tensor<1, 3> &x,
                             const double within,
                             std::vector<SurfacePoint> &parts) const
  {
    constexpr double tolerated = 1e-3; // of the reach: what may already have been entered

    Neighbours neighbours;
    collect(x, within, neighbours);
    double least = std::numeric_limits<double>::max();
    for (const auto &near : neighbours)
      least = std::min(least, (x - near.at.point).norm());
    // Who is further away than the box tells, or deep inside by mistake, looks further.
    SurfacePoint nearest = least + 2. * coincident * size <= within ? closest_among(x, neighbours) :
                                                                      closest(x);
    nearest.distance *= side;
    nearest.normal *= side;
    if (nearest.distance > within)
      return;
    const unsigned int first = parts.size();
    parts.push_back(nearest);
    // Whoever stays before the closest point's plane stays out of all that lies behind it.
    const auto foot        = x - nearest.distance * nearest.normal;
    const auto rises_above = [&](const std::array<unsigned int, 3> &t) {
      return std::any_of(t.begin(), t.end(), [&](const unsigned int v) {
        return (mesh.vertices[v] - foot) * nearest.normal > 1e-9 * size;
      });
    };
    for (const auto &[i, at] : neighbours)
      {
        if (!at.interior)
          continue;
        const auto &t         = mesh.triangles[i];
        const auto n          = mesh.normal(t) * (side / mesh.normal(t).norm());
        const double distance = (x - at.point) * n;
        if (distance > within || distance < -tolerated * within || !rises_above(t))
          continue;
        if (std::none_of(parts.begin() + first, parts.end(), [&](const SurfacePoint &part) {
              return part.normal * n > 1. - 1e-9;
            }))
          parts.push_back({distance, n});
      }
  }


  void
  TriangleShape::nearby(const Tensor<1, 3> &x,
                        const double within,
                        std::vector<SurfacePoint> &parts) const
  {
    nearby_from(1., x, within, parts);
  }


  void
  TriangleShape::nearby_from_inside(const Tensor<1, 3> &x,
                                    const double within,
                                    std::vector<SurfacePoint> &parts) const
  {
    nearby_from(-1., x, within, parts);
  }


  // Sums over the tetrahedra between the triangles (a, b, c) and a common point o, with D =
  // det(a, b, c): V = D/6, int x = D/24 s, int x x = D/120 (a a + b b + c c + s s), s = a + b + c.
  MassProperties
  TriangleShape::mass_properties(const double density) const
  {
    const Tensor<1, 3> o = mesh.vertices[0];
    double volume        = 0.;
    Tensor<1, 3> first;
    SymmetricTensor<2, 3> second;
    for (const auto &t : mesh.triangles)
      {
        const auto a = mesh.vertices[t[0]] - o, b = mesh.vertices[t[1]] - o,
                   c   = mesh.vertices[t[2]] - o;
        const double D = a * cross_product_3d(b, c);
        const auto s   = a + b + c;
        volume += D / 6.;
        first += D / 24. * s;
        for (const auto &v : {a, b, c, s})
          second += D / 120. * symmetrize(outer_product(v, v));
      }
    const auto centre = first / volume;
    second -= volume * symmetrize(outer_product(centre, centre));
    MassProperties result;
    result.mass    = density * volume;
    result.centre  = Point<3>(o + centre);
    result.inertia = density * (trace(second) * unit_symmetric_tensor<3>() - second);
    return result;
  }
} // namespace akmon
