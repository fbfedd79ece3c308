#include <akmon/output/history.h>
#include <akmon/rigid/triangle_mesh.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

namespace akmon
{
  using dealii::Tensor;

  namespace
  {
    constexpr double merge_distance = 1e-7; // over the size of the surface: single precision

    using Edge = std::pair<unsigned int, unsigned int>;

    // A triangle at an edge, and whether it runs through it from the smaller number to the larger.
    struct EdgeUse
    {
      unsigned int triangle;
      bool forward;
    };
    using EdgeUses = std::map<Edge, std::vector<EdgeUse>>;


    std::string
    number_of(const unsigned int n, const std::string &what)
    {
      return std::to_string(n) + " " + what + (n == 1 ? "" : "s");
    }


    double
    size_of(const TriangleMesh &mesh)
    {
      Tensor<1, 3> low = mesh.vertices[0], high = low;
      for (const auto &x : mesh.vertices)
        for (unsigned int d = 0; d < 3; ++d)
          {
            low[d]  = std::min(low[d], x[d]);
            high[d] = std::max(high[d], x[d]);
          }
      return (high - low).norm();
    }


    // A vertex takes the number of the first one within the distance; cells of that size hold them.
    void
    merge_vertices(TriangleMesh &mesh, const double distance)
    {
      using Cell = std::array<long long, 3>;
      std::map<Cell, std::vector<unsigned int>> cells;
      std::vector<Tensor<1, 3>> merged;
      std::vector<unsigned int> numbers;
      const auto find = [&](const Tensor<1, 3> &x, const Cell &at) {
        for (long long i = -1; i <= 1; ++i)
          for (long long j = -1; j <= 1; ++j)
            for (long long k = -1; k <= 1; ++k)
              {
                const auto cell = cells.find({{at[0] + i, at[1] + j, at[2] + k}});
                if (cell != cells.end())
                  for (const unsigned int v : cell->second)
                    if ((merged[v] - x).norm() <= distance)
                      return v;
              }
        return static_cast<unsigned int>(merged.size());
      };
      for (const auto &x : mesh.vertices)
        {
          Cell at;
          for (unsigned int d = 0; d < 3; ++d)
            at[d] = distance > 0. ? std::llround(x[d] / distance) : 0;
          const unsigned int v = find(x, at);
          if (v == merged.size())
            {
              merged.push_back(x);
              cells[at].push_back(v);
            }
          numbers.push_back(v);
        }
      for (auto &triangle : mesh.triangles)
        for (auto &corner : triangle)
          corner = numbers[corner];
      mesh.vertices = std::move(merged);
    }


    unsigned int
    drop_collapsed(TriangleMesh &mesh)
    {
      const auto collapsed = [](const auto &t) {
        return t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
      };
      auto &triangles      = mesh.triangles;
      const auto end       = std::remove_if(triangles.begin(), triangles.end(), collapsed);
      const unsigned int n = triangles.end() - end;
      triangles.erase(end, triangles.end());
      return n;
    }


    EdgeUses
    uses_of_edges(const TriangleMesh &mesh)
    {
      EdgeUses uses;
      for (unsigned int i = 0; i < mesh.triangles.size(); ++i)
        for (unsigned int k = 0; k < 3; ++k)
          {
            const unsigned int a = mesh.triangles[i][k], b = mesh.triangles[i][(k + 1) % 3];
            uses[{std::min(a, b), std::max(a, b)}].push_back({i, a < b});
          }
      return uses;
    }


    void
    refuse_open_edges(const TriangleMesh &mesh, const EdgeUses &uses)
    {
      unsigned int n_open = 0, n_crowded = 0;
      Tensor<1, 3> open, crowded;
      for (const auto &[edge, triangles] : uses)
        {
          const auto middle = 0.5 * (mesh.vertices[edge.first] + mesh.vertices[edge.second]);
          if (triangles.size() == 1 && n_open++ == 0)
            open = middle;
          if (triangles.size() > 2 && n_crowded++ == 0)
            crowded = middle;
        }
      if (n_open > 0)
        throw std::runtime_error("the surface has a hole: " + number_of(n_open, "edge") +
                                 " with a triangle on one side only, the first near " +
                                 place_text(open));
      if (n_crowded > 0)
        throw std::runtime_error("the surface touches itself: " + number_of(n_crowded, "edge") +
                                 " with more than two triangles, the first near " +
                                 place_text(crowded));
    }


    // Turn triangles so that neighbours run through their edge in opposite directions. Returns the
    // connected part of the surface each belongs to, and which were turned.
    struct Parts
    {
      std::vector<unsigned int> of_triangle;
      std::vector<bool> turned;
      unsigned int n = 0;
    };

    Parts
    align_neighbours(const TriangleMesh &mesh, const EdgeUses &uses)
    {
      constexpr unsigned int none = -1;
      std::vector<std::vector<std::pair<unsigned int, bool>>> neighbours(mesh.triangles.size());
      for (const auto &entry : uses)
        {
          const auto &[a, b]   = std::make_pair(entry.second[0], entry.second[1]);
          const bool disagrees = a.forward == b.forward;
          neighbours[a.triangle].push_back({b.triangle, disagrees});
          neighbours[b.triangle].push_back({a.triangle, disagrees});
        }
      Parts parts;
      parts.of_triangle.assign(mesh.triangles.size(), none);
      parts.turned.assign(mesh.triangles.size(), false);
      for (unsigned int seed = 0; seed < mesh.triangles.size(); ++seed)
        {
          if (parts.of_triangle[seed] != none)
            continue;
          std::vector<unsigned int> front = {seed};
          parts.of_triangle[seed]         = parts.n;
          while (!front.empty())
            {
              const unsigned int i = front.back();
              front.pop_back();
              for (const auto &[j, disagrees] : neighbours[i])
                if (parts.of_triangle[j] == none)
                  {
                    parts.of_triangle[j] = parts.n;
                    parts.turned[j]      = parts.turned[i] != disagrees;
                    front.push_back(j);
                  }
                else if (parts.turned[j] != (parts.turned[i] != disagrees))
                  throw std::runtime_error("the surface has no inside: like a Moebius band it "
                                           "cannot be oriented, near " +
                                           place_text(mesh.vertices[mesh.triangles[i][0]]));
            }
          ++parts.n;
        }
      return parts;
    }


    // Solid angle of a surface seen from x over 4 pi (Van Oosterom and Strackee, IEEE Trans.
    // Biomed. Eng. 30, 1983): one inside, zero outside.
    double
    winding_number(const TriangleMesh &mesh, const Tensor<1, 3> &x)
    {
      double sum = 0.;
      for (const auto &t : mesh.triangles)
        {
          const auto a = mesh.vertices[t[0]] - x, b = mesh.vertices[t[1]] - x,
                     c   = mesh.vertices[t[2]] - x;
          const double A = a.norm(), B = b.norm(), C = c.norm();
          sum += 2. * std::atan2(a * cross_product_3d(b, c),
                                 A * B * C + (a * b) * C + (b * c) * A + (c * a) * B);
        }
      return sum / (4. * dealii::numbers::PI);
    }


    void
    turn(std::array<unsigned int, 3> &triangle)
    {
      std::swap(triangle[1], triangle[2]);
    }


    // Normals out of the solid: outward on outer surfaces, into the hollow on those of cavities.
    // Returns how many triangles stand otherwise than before.
    unsigned int
    turn_outward(TriangleMesh &mesh, const EdgeUses &uses, const double size)
    {
      const Parts parts = align_neighbours(mesh, uses);
      std::vector<TriangleMesh> surfaces(parts.n, TriangleMesh{mesh.vertices, {}});
      for (unsigned int i = 0; i < mesh.triangles.size(); ++i)
        {
          if (parts.turned[i])
            turn(mesh.triangles[i]);
          surfaces[parts.of_triangle[i]].triangles.push_back(mesh.triangles[i]);
        }
      std::vector<bool> reverse(parts.n);
      for (unsigned int p = 0; p < parts.n; ++p)
        {
          const double volume = surfaces[p].volume();
          if (std::abs(volume) <= 1e-12 * size * size * size)
            throw std::runtime_error("a part of the surface encloses no volume, near " +
                                     place_text(mesh.vertices[surfaces[p].triangles[0][0]]));
          bool hollow = false;
          for (unsigned int other = 0; other < parts.n; ++other)
            if (other != p &&
                std::abs(winding_number(surfaces[other],
                                        mesh.vertices[surfaces[p].triangles[0][0]])) > 0.5)
              hollow = !hollow;
          reverse[p] = (volume < 0.) != hollow;
        }
      unsigned int n_turned = 0;
      for (unsigned int i = 0; i < mesh.triangles.size(); ++i)
        {
          if (reverse[parts.of_triangle[i]])
            turn(mesh.triangles[i]);
          n_turned += parts.turned[i] != reverse[parts.of_triangle[i]];
        }
      return n_turned;
    }
  } // namespace


  double
  TriangleMesh::volume() const
  {
    const Tensor<1, 3> origin = vertices.empty() ? Tensor<1, 3>() : vertices[0];
    double sum                = 0.;
    for (const auto &t : triangles)
      sum += (vertices[t[0]] - origin) *
             cross_product_3d(vertices[t[1]] - origin, vertices[t[2]] - origin) / 6.;
    return sum;
  }


  std::vector<std::string>
  make_closed(TriangleMesh &mesh)
  {
    const double size = size_of(mesh);
    merge_vertices(mesh, merge_distance * size);
    const unsigned int n_collapsed = drop_collapsed(mesh);
    if (mesh.triangles.empty())
      throw std::runtime_error("all its triangles have zero area");
    const EdgeUses uses = uses_of_edges(mesh);
    refuse_open_edges(mesh, uses);
    const unsigned int n_flat   = std::count_if(mesh.triangles.begin(),
                                              mesh.triangles.end(),
                                              [&](const auto &triangle) {
                                                return mesh.normal(triangle).norm() <=
                                                       merge_distance * merge_distance * size *
                                                         size;
                                              });
    const unsigned int n_turned = turn_outward(mesh, uses, size);

    std::vector<std::string> repairs;
    if (n_collapsed + n_flat > 0)
      repairs.push_back(number_of(n_collapsed + n_flat, "triangle") + " of zero area left out");
    if (n_turned > 0)
      repairs.push_back(number_of(n_turned, "triangle") +
                        (n_turned == 1 ? " whose normal" : " whose normals") +
                        " pointed inward turned round");
    return repairs;
  }
} // namespace akmon
