#include <akmon/model/body.h>
#include <akmon/model/copies.h>
#include <akmon/parameters.h>
#include <akmon/rigid/rotation.h>

#include <deal.II/base/numbers.h>
#include <deal.II/base/utilities.h>

#include <cmath>
#include <random>
#include <set>

namespace akmon
{
  using namespace dealii;

  namespace
  {
    // Uniform in (0, 1). The distributions of the standard library differ between compilers.
    double
    uniform(std::mt19937 &generator)
    {
      return (generator() + 0.5) / 4294967296.;
    }


    // Uniform among all rotations (Shoemake, Graphics Gems III, 1992): the matrix of a random unit
    // quaternion (w, v), 1 + 2 w [v x] + 2 [v x]^2.
    Tensor<2, 3>
    random_rotation(std::mt19937 &generator)
    {
      const double part = uniform(generator), a = 2. * numbers::PI * uniform(generator),
                   b     = 2. * numbers::PI * uniform(generator);
      const double small = std::sqrt(1. - part), large = std::sqrt(part);
      const Tensor<1, 3> v({small * std::sin(a), small * std::cos(a), large * std::sin(b)});
      const double w        = large * std::cos(b);
      const auto V          = cross_matrix(v);
      Tensor<2, 3> rotation = 2. * (w * V + V * V);
      for (unsigned int d = 0; d < 3; ++d)
        rotation[d][d] += 1.;
      return rotation;
    }


    void
    append_copies(const Body &body, std::vector<Body> &result)
    {
      const Copies &copies = body.copies;
      std::mt19937 generator(copies.seed);
      for (unsigned int i = 0; i < copies.n(); ++i)
        {
          const std::array<unsigned int, 3> place = {{i % copies.count[0],
                                                      i / copies.count[0] % copies.count[1],
                                                      i / copies.count[0] / copies.count[1]}};
          Body copy                               = body;
          copy.family                             = body.name;
          copy.copy                               = i;
          copy.name += "." + std::to_string(i + 1);
          for (unsigned int d = 0; d < 3; ++d)
            copy.position[d] += place[d] * copies.spacing[d] +
                                copies.jitter * (2. * uniform(generator) - 1.);
          if (copies.turn)
            copy.rotation = random_rotation(generator) * body.rotation;
          result.push_back(copy);
        }
    }
  } // namespace


  void
  Copies::declare(ParameterHandler &prm)
  {
    prm
      .declare_entry("Count",
                     "1, 1, 1",
                     Patterns::List(Patterns::Integer(1, 1000), 3, 3),
                     "How often the body stands along x, y and z; copies are named NAME.1, NAME.2, "
                     "..., and NAME:PART is the part of all of them");
    declare_vector(prm, "Spacing", "0, 0, 0", "Distances of neighbouring copies (length)");
    prm.declare_entry("Jitter",
                      "0",
                      Patterns::Double(0.),
                      "Largest random shift of a copy along each axis (length)");
    prm.declare_entry("Turn",
                      "false",
                      Patterns::Bool(),
                      "Turn every copy about its frame's origin at random");
    prm.declare_entry("Seed",
                      "1",
                      Patterns::Integer(0),
                      "Seed of the random shifts and turns: another number, another arrangement");
  }


  void
  Copies::parse(ParameterHandler &prm, const std::string &section)
  {
    constexpr double most = 1e5;

    const auto texts = split_list(prm.get("Count"));
    if (texts.size() != 3)
      throw InputError(section, "Count", prm.get("Count"), "allowed are three whole numbers");
    double number = 1.;
    for (unsigned int d = 0; d < 3; ++d)
      {
        count[d] = Utilities::string_to_int(texts[d]);
        number *= count[d];
      }
    if (number > most)
      throw InputError(section, "Count", prm.get("Count"), "allowed are up to 100000 copies");
    spacing = get_vector(prm, section, "Spacing");
    for (unsigned int d = 0; d < 3; ++d)
      if (count[d] > 1 && spacing[d] == 0.)
        throw InputError(section,
                         "Spacing",
                         prm.get("Spacing"),
                         "it must not be zero along an axis with several copies");
    jitter = prm.get_double("Jitter");
    turn   = prm.get_bool("Turn");
    seed   = prm.get_integer("Seed");
  }


  std::vector<Body>
  with_copies(const std::vector<Body> &bodies)
  {
    std::vector<Body> result;
    for (const auto &body : bodies)
      if (body.copies.n() > 1)
        append_copies(body, result);
      else
        result.push_back(body);
    std::set<std::string> names;
    for (const auto &body : result)
      if (!names.insert(body.name).second)
        throw InputError("Bodies", "Names", body.name, "a copy of another body has this name");
    return result;
  }
} // namespace akmon
