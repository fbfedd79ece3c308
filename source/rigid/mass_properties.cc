#include <akmon/rigid/mass_properties.h>
#include <akmon/rigid/rigid_shape.h>

#include <deal.II/base/quadrature_lib.h>

#include <cmath>
#include <limits>

// Mass properties of cylinders and boxes with rounded edges, layer by layer.

namespace akmon
{
  using namespace dealii;

  namespace
  {
    // A cross-section normal to z, with z as an axis of symmetry: area and int x^2 dA, int y^2 dA.
    struct Layer
    {
      double area, xx, yy;
    };


    /*
     * A solid of layers between -h and h, symmetric to z = 0, whose section is a function of the
     * reach s of the rounding at its height: s = r up to |z| = h - r, then with z = h - r + r sin p
     * the quarter circle s = r cos p. All integrands are polynomials of sin and cos.
     */
    template <typename Section>
    MassProperties
    solid_of_layers(const double density, const double h, const double r, const Section &section)
    {
      static const QGauss<1> quadrature(20);
      double volume = 0., xx = 0., yy = 0., zz = 0.;
      const auto add = [&](const double z, const double dz, const double s) {
        const Layer layer = section(s);
        volume += 2. * layer.area * dz;
        xx += 2. * layer.xx * dz;
        yy += 2. * layer.yy * dz;
        zz += 2. * layer.area * z * z * dz;
      };
      for (unsigned int q = 0; q < quadrature.size(); ++q)
        {
          const double xi = quadrature.point(q)[0], w = quadrature.weight(q);
          add((h - r) * xi, (h - r) * w, r);
          if (r > 0.)
            {
              const double p = 0.5 * numbers::PI * xi;
              add(h - r + r * std::sin(p),
                  r * std::cos(p) * 0.5 * numbers::PI * w,
                  r * std::cos(p));
            }
        }
      MassProperties result;
      result.mass          = density * volume;
      result.inertia[0][0] = density * (yy + zz);
      result.inertia[1][1] = density * (zz + xx);
      result.inertia[2][2] = density * (xx + yy);
      return result;
    }
  } // namespace


  MassProperties
  MassProperties::infinite()
  {
    MassProperties result;
    result.mass    = std::numeric_limits<double>::infinity();
    result.inertia = result.mass * unit_symmetric_tensor<3>();
    return result;
  }


  // Discs of radius R - r + s: area pi rho^2, int x^2 dA = pi rho^4/4.
  MassProperties
  RoundBarShape::mass_properties(const double density) const
  {
    if (std::isinf(half_length))
      return MassProperties::infinite();
    return solid_of_layers(density, half_length, edge, [&](const double s) {
      const double square = (R - edge + s) * (R - edge + s);
      const double second = 0.25 * numbers::PI * square * square;
      return Layer{numbers::PI * square, second, second};
    });
  }


  // A rectangle 2a x 2b widened by s: middle, strips at its sides, a quarter disc at each corner.
  MassProperties
  BlockShape::mass_properties(const double density) const
  {
    const double a = half[0] - edge, b = half[1] - edge;
    return solid_of_layers(density, half[2], edge, [&](const double s) {
      const auto second = [&](const double a, const double b) {
        const double reach = a + s;
        return 4. / 3. * a * a * a * (b + s) + 4. / 3. * b * (reach * reach * reach - a * a * a) +
               numbers::PI * a * a * s * s + 8. / 3. * a * s * s * s +
               0.25 * numbers::PI * s * s * s * s;
      };
      return Layer{4. * a * b + 4. * (a + b) * s + numbers::PI * s * s, second(a, b), second(b, a)};
    });
  }
} // namespace akmon
