#pragma once

#include <deal.II/base/utilities.h>

#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <vector>
#include <zlib.h>

#include "support/files.h"

namespace akmon::test
{
  /// The numbers of a compressed data array: a header that is encoded by itself (number of blocks,
  /// size of a block, size of the last one, compressed sizes), then the blocks.
  inline std::vector<float>
  decode_floats(const std::string &encoded)
  {
    using dealii::Utilities::decode_base64;
    const auto word = [](const std::vector<unsigned char> &bytes, const std::size_t i) {
      std::uint32_t value;
      std::memcpy(&value, bytes.data() + 4 * i, 4);
      return value;
    };
    const std::size_t n_blocks = word(decode_base64(encoded.substr(0, 8)), 0);
    const std::size_t n_header = 4 * ((4 * (3 + n_blocks) + 2) / 3);
    const auto header          = decode_base64(encoded.substr(0, n_header));
    const auto blob            = decode_base64(encoded.substr(n_header));
    std::vector<float> values;
    std::size_t begin = 0;
    for (std::size_t i = 0; i < n_blocks; ++i)
      {
        uLongf n_bytes = word(header, i + 1 == n_blocks && word(header, 2) > 0 ? 2 : 1);
        std::vector<unsigned char> block(n_bytes);
        if (uncompress(block.data(), &n_bytes, blob.data() + begin, word(header, 3 + i)) != Z_OK)
          throw std::runtime_error("a block of a .vtu file cannot be decompressed");
        begin += word(header, 3 + i);
        const std::size_t n_before = values.size();
        values.resize(n_before + n_bytes / sizeof(float));
        std::memcpy(values.data() + n_before, block.data(), n_bytes);
      }
    return values;
  }


  /// The values of a field, or of "Points", in all pieces of a .vtu file.
  inline std::vector<float>
  field_of_vtu(const std::string &path, const std::string &name)
  {
    const std::string text = file_content(path),
                      key  = name == "Points" ? "<Points>" : "Name=\"" + name + "\"";
    std::vector<float> values;
    for (auto at = text.find(key); at != std::string::npos; at = text.find(key, at + 1))
      {
        const auto array    = name == "Points" ? text.find("<DataArray", at) : at;
        const auto begin    = text.find_first_not_of(" \n", text.find('>', array) + 1);
        const auto of_piece = decode_floats(
          text.substr(begin, text.find_first_of(" \n<", begin) - begin));
        values.insert(values.end(), of_piece.begin(), of_piece.end());
      }
    return values;
  }
} // namespace akmon::test
