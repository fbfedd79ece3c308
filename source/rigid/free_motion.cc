#include <akmon/rigid/free_motion.h>

#include <algorithm>

namespace akmon
{
  using namespace dealii;

  FreeMotion::FreeMotion(const MassProperties &properties,
                         const Freedom &freedom,
                         const Pose &pose,
                         const Tensor<1, 3> &velocity,
                         const Tensor<1, 3> &spin)
    : properties(properties)
    , freedom(freedom)
    , n_rotations(std::count(freedom.rotation.begin(), freedom.rotation.end(), true))
    , inertia(properties.inertia)
    , inverse_inertia(invert(Tensor<2, 3>(properties.inertia)))
    , frame(pose)
  {
    momentum_before = momentum_after = properties.mass * held(velocity, freedom.translation);
    const auto omega                 = held(spin, freedom.rotation);
    const auto R                     = rotation();
    turning_before = turning_after = held(R * (inertia * (transpose(R) * omega)), freedom.rotation);
  }


  // The part of a vector along the axes that are free.
  Tensor<1, 3>
  FreeMotion::held(const Tensor<1, 3> &v, const std::array<bool, 3> &free) const
  {
    Tensor<1, 3> result;
    for (unsigned int d = 0; d < 3; ++d)
      result[d] = free[d] ? v[d] : 0.;
    return result;
  }


  // L_{1/2} = L_0 (1 - eta dt/2) + (dt/2) M_0, and L_{-1/2} such that L_0 is in the middle
  void
  FreeMotion::start(const Tensor<1, 3> &force,
                    const Tensor<1, 3> &moment,
                    const double step,
                    const double eta)
  {
    dt = dt_next   = step;
    damping        = eta;
    divisor        = 2. / dt;
    momentum_after = (1. - 0.5 * eta * dt) * momentum_before;
    turning_after  = (1. - 0.5 * eta * dt) * turning_before;
    add(force, moment);
  }


  void
  FreeMotion::free_increment(const Tensor<1, 3> &force,
                             const Tensor<1, 3> &moment,
                             const double step,
                             const double next_step,
                             const double eta)
  {
    dt                  = step;
    dt_next             = next_step;
    damping             = eta;
    const double dt_bar = 0.5 * (dt + dt_next);
    divisor             = 1. / dt_bar + 0.5 * eta;
    const double carry  = (1. / dt_bar - 0.5 * eta) / divisor;
    momentum_after      = carry * momentum_before;
    turning_after       = carry * turning_before;
    add(force, moment);
  }


  void
  FreeMotion::add(const Tensor<1, 3> &force, const Tensor<1, 3> &moment)
  {
    momentum_after += held(force, freedom.translation) / divisor;
    turning_after += held(moment, freedom.rotation) / divisor;
    set_increments();
  }


  void
  FreeMotion::set_increments()
  {
    const auto of_level =
      [&](const Tensor<1, 3> &momentum, const Tensor<1, 3> &turning, const double step) {
        return RigidIncrement{(step / properties.mass) * momentum,
                              step * (rotation_mobility() * turning)};
      };
    // At the start L_0 is in the middle between both half steps.
    const double mirror = starting ? 1. : 0.;
    before              = of_level(momentum_before + mirror * (momentum_before - momentum_after),
                      turning_before + mirror * (turning_before - turning_after),
                      dt);
    after               = of_level(momentum_after, turning_after, dt_next);
    ahead.centre        = after.centre;
    ahead.rotation      = rotation_vector();
  }


  // T of I T + (1/2) T x (I T) = dt R^T L by Newton's method from T = dt I^{-1} R^T L, in space.
  Tensor<1, 3>
  FreeMotion::rotation_vector() const
  {
    if (n_rotations < 3)
      return after.rotation; // about a fixed axis or not at all
    const auto R      = rotation();
    const auto target = dt_next * (transpose(R) * turning_after);
    auto T            = inverse_inertia * target;
    for (unsigned int i = 0; i < 20; ++i)
      {
        const auto IT       = inertia * T;
        const auto residual = IT + 0.5 * cross_product_3d(T, IT) - target;
        if (residual.norm() <= 1e-16 * target.norm())
          break;
        T -= invert(inertia + 0.5 * (cross_matrix(T) * inertia - cross_matrix(IT))) * residual;
      }
    return R * T;
  }


  void
  FreeMotion::predict()
  {
    frame           = next_pose();
    momentum_before = momentum_after;
    turning_before  = turning_after;
    starting        = false;
  }


  Pose
  FreeMotion::next_pose() const
  {
    // The frame's origin turns about the centre of mass.
    const auto turn  = Orientation::cayley(ahead.rotation);
    const auto arm   = rotation() * properties.centre;
    const auto place = centre() + ahead.centre - turn.matrix() * arm;
    return {place, turn * frame.orientation};
  }


  // The momenta that forces add follow from the response: m dX/dt' and I dT/dt'.
  Pose
  FreeMotion::next_pose(const RigidIncrement &response) const
  {
    FreeMotion after_forces(*this);
    const auto R = rotation();
    after_forces.momentum_after += (properties.mass / dt_next) * response.centre;
    after_forces.turning_after += held(R * inertia * transpose(R) * response.rotation / dt_next,
                                       freedom.rotation);
    after_forces.set_increments();
    return after_forces.next_pose();
  }


  Tensor<1, 3>
  FreeMotion::centre() const
  {
    return frame.place + rotation() * properties.centre;
  }


  SymmetricTensor<2, 3>
  FreeMotion::translation_mobility() const
  {
    SymmetricTensor<2, 3> result;
    for (unsigned int d = 0; d < 3; ++d)
      result[d][d] = freedom.translation[d] ? 1. / properties.mass : 0.;
    return result;
  }


  SymmetricTensor<2, 3>
  FreeMotion::rotation_mobility() const
  {
    if (n_rotations == 0)
      return SymmetricTensor<2, 3>();
    const auto R = rotation();
    if (n_rotations == 3)
      return symmetrize(R * inverse_inertia * transpose(R));
    const Tensor<2, 3> in_space = R * inertia * transpose(R);
    SymmetricTensor<2, 3> result;
    for (unsigned int d = 0; d < 3; ++d)
      if (freedom.rotation[d])
        result[d][d] = 1. / in_space[d][d];
    return result;
  }


  Tensor<1, 3>
  FreeMotion::velocity() const
  {
    return 0.5 * (before.centre / dt + after.centre / dt_next);
  }


  Tensor<1, 3>
  FreeMotion::spin() const
  {
    return 0.5 * (before.rotation / dt + after.rotation / dt_next);
  }


  Tensor<1, 3>
  FreeMotion::momentum() const
  {
    return properties.mass * velocity();
  }


  Tensor<1, 3>
  FreeMotion::angular_momentum() const
  {
    const auto own = starting ? turning_before : 0.5 * (turning_before + turning_after);
    return own + cross_product_3d(centre(), momentum());
  }


  double
  FreeMotion::kinetic_energy() const
  {
    const auto R            = rotation();
    const auto I            = R * inertia * transpose(R);
    const auto twice_energy = [&](const RigidIncrement &rate) {
      return properties.mass * (rate.centre * rate.centre) + rate.rotation * (I * rate.rotation);
    };
    if (starting)
      return 0.5 * twice_energy({velocity(), spin()});
    const double dt_bar = 0.5 * (dt + dt_next);
    const auto mix =
      [](const double a, const RigidIncrement &u, const double b, const RigidIncrement &v) {
        return RigidIncrement{a * u.centre + b * v.centre, a * u.rotation + b * v.rotation};
      };
    const auto mean   = mix(dt_next / dt / (dt + dt_next),
                          before,
                          dt / dt_next / (dt + dt_next),
                          after);
    const auto change = mix(-1. / dt / dt_bar, before, 1. / dt_next / dt_bar, after);
    return 0.5 * (twice_energy(mean) - 0.25 * dt * dt_next * twice_energy(change));
  }


  double
  FreeMotion::damping_work(const RigidIncrement &increment) const
  {
    if (damping == 0.)
      return 0.;
    const auto R = rotation();
    const auto L = R * (inertia * (transpose(R) * spin()));
    return -damping * (momentum() * increment.centre + L * increment.rotation);
  }
} // namespace akmon
