#include <akmon/rigid/triangle_mesh.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace akmon
{
  using dealii::Tensor;

  namespace
  {
    constexpr std::size_t header_bytes = 80, triangle_bytes = 50;


    std::string
    all_of_file(const std::string &file)
    {
      std::error_code error;
      if (!std::filesystem::is_regular_file(file, error))
        throw std::runtime_error("there is no such file");
      std::ifstream in(file, std::ios::binary);
      std::ostringstream content;
      content << in.rdbuf();
      if (!in || content.str().empty())
        throw std::runtime_error("the file is empty or cannot be read");
      return content.str();
    }


    // Some exporters begin binary files with "solid" too: the size decides.
    bool
    is_binary(const std::string &content)
    {
      if (content.size() < header_bytes + 4)
        return false;
      std::uint32_t n;
      std::memcpy(&n, content.data() + header_bytes, 4);
      return content.size() == header_bytes + 4 + triangle_bytes * std::uint64_t(n);
    }


    void
    append(TriangleMesh &mesh, const std::array<Tensor<1, 3>, 3> &corners)
    {
      for (const auto &corner : corners)
        for (unsigned int d = 0; d < 3; ++d)
          if (!std::isfinite(corner[d]))
            throw std::runtime_error("triangle " + std::to_string(mesh.triangles.size() + 1) +
                                     " has a corner that is not a number");
      const unsigned int first = mesh.vertices.size();
      mesh.vertices.insert(mesh.vertices.end(), corners.begin(), corners.end());
      mesh.triangles.push_back({{first, first + 1, first + 2}});
    }


    // Per triangle: normal, three corners (twelve 32-bit numbers), two bytes of anything.
    TriangleMesh
    read_binary(const std::string &content)
    {
      TriangleMesh mesh;
      for (std::size_t at = header_bytes + 4; at < content.size(); at += triangle_bytes)
        {
          std::array<float, 12> numbers;
          std::memcpy(numbers.data(), content.data() + at, sizeof(numbers));
          std::array<Tensor<1, 3>, 3> corners;
          for (unsigned int i = 0; i < 9; ++i)
            corners[i / 3][i % 3] = numbers[3 + i];
          append(mesh, corners);
        }
      return mesh;
    }


    TriangleMesh
    read_ascii(const std::string &content)
    {
      TriangleMesh mesh;
      std::istringstream in(content);
      std::string line, word;
      std::array<Tensor<1, 3>, 3> corners;
      unsigned int n_corners = 0, line_number = 0;
      while (std::getline(in, line))
        {
          ++line_number;
          std::istringstream words(line);
          if (!(words >> word))
            continue;
          std::transform(word.begin(), word.end(), word.begin(), [](const unsigned char c) {
            return std::tolower(c);
          });
          const bool known = word == "solid" || word == "facet" || word == "outer" ||
                             word == "vertex" || word == "endloop" || word == "endfacet" ||
                             word == "endsolid";
          if (word == "facet")
            n_corners = 0;
          bool good = known && (line_number > 1 || word == "solid");
          if (word == "vertex")
            {
              double x, y, z;
              good = n_corners < 3 && (words >> x >> y >> z);
              if (good)
                corners[n_corners++] = Tensor<1, 3>({x, y, z});
            }
          if (word == "endfacet")
            {
              good = n_corners == 3;
              if (good)
                append(mesh, corners);
            }
          if (!good)
            throw std::runtime_error("line " + std::to_string(line_number) +
                                     " is not that of an STL file, ASCII or binary");
        }
      return mesh;
    }
  } // namespace


  TriangleMesh
  read_stl(const std::string &file)
  {
    const std::string content = all_of_file(file);
    TriangleMesh mesh         = is_binary(content) ? read_binary(content) : read_ascii(content);
    if (mesh.triangles.empty())
      throw std::runtime_error("there are no triangles in it");
    return mesh;
  }
} // namespace akmon
