#pragma once

#include <akmon/rigid/rigid_shape.h>
#include <akmon/rigid/triangle_mesh.h>

#include <boost/container/small_vector.hpp>

#include <memory>

namespace akmon
{
  /// Where a point is closest to a triangle.
  struct TrianglePoint
  {
    dealii::Tensor<1, 3> point;
    double angle;  ///< of the triangle around the point: 2 pi inside, pi on edges, less at corners
    bool interior; ///< neither on an edge nor at a corner
  };


  /**
   * The solid within a closed surface of triangles, in the frame of its vertices. What is inside is
   * told by the angle-weighted normals of the triangles at the closest point (Baerentzen and
   * Aanaes, IEEE Trans. Vis. Comput. Graph. 11, 2005).
   */
  class TriangleShape : public RigidShape
  {
  public:
    /// @param mesh  closed, normals outward: see make_closed()
    explicit TriangleShape(TriangleMesh mesh);

    ~TriangleShape() override;

    SurfacePoint
    closest(const dealii::Tensor<1, 3> &x) const override;

    /// The closest part and, where the surface is concave, all faces that x lies above.
    void
    nearby(const dealii::Tensor<1, 3> &x,
           const double within,
           std::vector<SurfacePoint> &parts) const override;

    void
    nearby_from_inside(const dealii::Tensor<1, 3> &x,
                       const double within,
                       std::vector<SurfacePoint> &parts) const override;

    /// Vertices, and edges that are not flat.
    void
    touch_points(const DistanceField &other,
                 const double within,
                 std::vector<TouchPoint> &points) const override;

    SharpFeatures
    sharp_features(const double least_angle) const override;

    double
    radius() const override
    {
      return furthest;
    }

    MassProperties
    mass_properties(const double density) const override;

    const TriangleMesh &
    surface() const
    {
      return mesh;
    }

  private:
    struct Tree;

    /// A triangle near a point, and where it is closest.
    struct Near
    {
      unsigned int triangle;
      TrianglePoint at;
    };
    using Neighbours = boost::container::small_vector<Near, 64>;

    /// Triangles whose box is within a distance of x, in the order of their numbers.
    void
    collect(const dealii::Tensor<1, 3> &x, const double within, Neighbours &neighbours) const;

    /// Bound of the distance of x, such that all triangles there are within it.
    double
    bound_of_distance(const dealii::Tensor<1, 3> &x) const;
    SurfacePoint
    closest_among(const dealii::Tensor<1, 3> &x, const Neighbours &neighbours) const;
    TrianglePoint
    on_triangle(const dealii::Tensor<1, 3> &x, const unsigned int triangle) const;
    void
    nearby_from(const double side,
                const dealii::Tensor<1, 3> &x,
                const double within,
                std::vector<SurfacePoint> &parts) const;

    void
    find_sharp_edges();

    // Whether a triangle's normal is more than rounding.
    bool
    has_direction(const dealii::Tensor<1, 3> &normal) const
    {
      return normal.norm() > 1e-14 * size * size;
    }

    struct SharpEdge
    {
      std::array<unsigned int, 2> ends;            ///< numbers of vertices
      std::array<dealii::Tensor<1, 3>, 2> normals; ///< of the triangles on both sides
    };

    const TriangleMesh mesh;
    std::vector<SharpEdge> sharp_edges;
    double furthest = 0., size = 0.;
    std::unique_ptr<Tree> tree;
  };


  /// Closest point of a triangle (Ericson, Real-Time Collision Detection, 2005, section 5.1.5).
  TrianglePoint
  closest_on_triangle(const dealii::Tensor<1, 3> &x,
                      const dealii::Tensor<1, 3> &a,
                      const dealii::Tensor<1, 3> &b,
                      const dealii::Tensor<1, 3> &c);
} // namespace akmon
