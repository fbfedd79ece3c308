#pragma once

#include <akmon/rigid/mass_properties.h>
#include <akmon/rigid/sharp_features.h>

#include <deal.II/base/point.h>
#include <deal.II/base/tensor.h>

#include <functional>
#include <limits>
#include <memory>
#include <vector>

namespace akmon
{
  /// What a shape is to a point near it: the closest point of its surface is x - distance * normal.
  struct SurfacePoint
  {
    double distance;             ///< negative inside; length
    dealii::Tensor<1, 3> normal; ///< outward unit normal, the gradient of the distance
    bool on_feature = false;     ///< whether touch_points() of the shape looks at what is there
  };


  /// Signed distance to another shape, in the first one's frame.
  using DistanceField = std::function<SurfacePoint(const dealii::Tensor<1, 3> &)>;


  /**
   * A point of a rigid shape's skeleton that may touch something: the surface is the skeleton blown
   * up by a radius. Features are corners, edges, rims and axes; their numbers stay while the shape
   * moves.
   *
   * On the surface of the other shape distances along sharp edges have no normal that could be told
   * from rounding. So what is sharp looks at the other from a little inside.
   */
  struct TouchPoint
  {
    unsigned int feature;
    unsigned int number;       ///< of the point among those of its feature
    bool least;                ///< whether no other point of the feature around it is closer
    dealii::Tensor<1, 3> x;    ///< on the skeleton, in the shape's frame; length
    dealii::Tensor<1, 3> from; ///< where it looks from, seen from x; zero if it is round; length
    double radius;             ///< length
    SurfacePoint other;        ///< the other shape from the surface

    /// Look at the other shape.
    void
    look(const DistanceField &field)
    {
      other = field(x + from);
      other.distance -= radius + other.normal * from;
    }
  };


  /**
   * The shape of a rigid obstacle, in a frame of its own: a signed distance and what comes with it.
   * Distances are exact, inside and outside.
   */
  class RigidShape
  {
  public:
    virtual ~RigidShape() = default;

    /// The closest point of the surface.
    virtual SurfacePoint
    closest(const dealii::Tensor<1, 3> &x) const = 0;

    /**
     * Append all parts of the surface that a point outside may run into within a distance, each as
     * if it were alone: one, the closest, unless the surface is concave. Nothing if all are further
     * away.
     */
    virtual void
    nearby(const dealii::Tensor<1, 3> &x,
           const double within,
           std::vector<SurfacePoint> &parts) const;

    /// The same for a point inside and the surface seen from there: distances positive inside,
    /// normals inward.
    virtual void
    nearby_from_inside(const dealii::Tensor<1, 3> &x,
                       const double within,
                       std::vector<SurfacePoint> &parts) const;

    /**
     * Append the points that come closest to another shape, feature by feature, if within a
     * distance: all that do so locally, and of a rim others a quarter and half a turn away, for
     * what stands on it. Faces have none: what lies between faces is told by the features of the
     * other.
     */
    virtual void
    touch_points(const DistanceField &other,
                 const double within,
                 std::vector<TouchPoint> &points) const;

    /**
     * Its sharp corners and edges, none by default. Rims of cylinders are not among them.
     * @param least_angle  by which the surface turns at an edge; radians
     */
    virtual SharpFeatures
    sharp_features(const double least_angle) const;

    /// Distance of the surface's furthest point from the frame's origin; length.
    virtual double
    radius() const = 0;

    /// Mass, centre and inertia of the solid shape for a density. Infinite shapes have none
    /// (infinite mass).
    virtual MassProperties
    mass_properties(const double density) const = 0;
  };


  /// The half space z <= 0.
  class PlaneShape : public RigidShape
  {
  public:
    SurfacePoint
    closest(const dealii::Tensor<1, 3> &x) const override;

    double
    radius() const override
    {
      return std::numeric_limits<double>::infinity();
    }

    MassProperties
    mass_properties(const double density) const override;
  };


  /// A ball around the origin.
  class BallShape : public RigidShape
  {
  public:
    /// @param radius  length
    explicit BallShape(const double radius);

    SurfacePoint
    closest(const dealii::Tensor<1, 3> &x) const override;

    double
    radius() const override
    {
      return R;
    }

    void
    touch_points(const DistanceField &other,
                 const double within,
                 std::vector<TouchPoint> &points) const override;

    MassProperties
    mass_properties(const double density) const override;

  private:
    const double R;
  };


  /// A cylinder along z around the origin, its rims rounded or sharp.
  class RoundBarShape : public RigidShape
  {
  public:
    /**
     * @param radius       length
     * @param length       from end to end; may be infinite
     * @param edge_radius  of the rounding at the rims, zero: sharp; length
     */
    RoundBarShape(const double radius, const double length, const double edge_radius);

    SurfacePoint
    closest(const dealii::Tensor<1, 3> &x) const override;

    void
    nearby_from_inside(const dealii::Tensor<1, 3> &x,
                       const double within,
                       std::vector<SurfacePoint> &parts) const override;

    double
    radius() const override;

    void
    touch_points(const DistanceField &other,
                 const double within,
                 std::vector<TouchPoint> &points) const override;

    MassProperties
    mass_properties(const double density) const override;

  private:
    const double R, half_length, edge;
  };


  /// A box around the origin, its edges and corners rounded or sharp.
  class BlockShape : public RigidShape
  {
  public:
    /**
     * @param size         lengths of the edges
     * @param edge_radius  of the rounding, zero: sharp; length
     */
    BlockShape(const dealii::Tensor<1, 3> &size, const double edge_radius);

    SurfacePoint
    closest(const dealii::Tensor<1, 3> &x) const override;

    void
    nearby_from_inside(const dealii::Tensor<1, 3> &x,
                       const double within,
                       std::vector<SurfacePoint> &parts) const override;

    double
    radius() const override;

    void
    touch_points(const DistanceField &other,
                 const double within,
                 std::vector<TouchPoint> &points) const override;

    SharpFeatures
    sharp_features(const double least_angle) const override;

    MassProperties
    mass_properties(const double density) const override;

  private:
    const dealii::Tensor<1, 3> half;
    const double edge;
  };


  /// A torus around the z axis.
  class TorusShape : public RigidShape
  {
  public:
    /**
     * @param ring_radius  of the circle in the middle of the tube; length
     * @param tube_radius  less than the ring's; length
     */
    TorusShape(const double ring_radius, const double tube_radius);

    SurfacePoint
    closest(const dealii::Tensor<1, 3> &x) const override;

    double
    radius() const override
    {
      return ring + tube;
    }

    void
    touch_points(const DistanceField &other,
                 const double within,
                 std::vector<TouchPoint> &points) const override;

    MassProperties
    mass_properties(const double density) const override;

  private:
    const double ring, tube;
  };


  /// The room inside another shape, for containers and dies: what was outside is solid.
  class HollowShape : public RigidShape
  {
  public:
    explicit HollowShape(std::shared_ptr<const RigidShape> shape);

    SurfacePoint
    closest(const dealii::Tensor<1, 3> &x) const override;

    void
    nearby(const dealii::Tensor<1, 3> &x,
           const double within,
           std::vector<SurfacePoint> &parts) const override;

    void
    nearby_from_inside(const dealii::Tensor<1, 3> &x,
                       const double within,
                       std::vector<SurfacePoint> &parts) const override;

    double
    radius() const override
    {
      return shape->radius();
    }

    /// Infinite.
    MassProperties
    mass_properties(const double density) const override;

  private:
    const std::shared_ptr<const RigidShape> shape;
  };
} // namespace akmon
