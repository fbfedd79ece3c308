#include <akmon/checkpoint/checkpoint_file.h>
#include <akmon/checkpoint/hdf5.h>
#include <akmon/output/directory.h>
#include <akmon/parameters.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <regex>
#include <stdexcept>
#include <unistd.h>
#include <zlib.h>

namespace akmon
{
  namespace
  {
    namespace fs = std::filesystem;
    using dealii::Utilities::MPI::n_mpi_processes;
    using dealii::Utilities::MPI::this_mpi_process;

    constexpr const char *magic = "Akmon checkpoint";


    // CRC-32 of a part of a file. Throws std::runtime_error.
    std::uint32_t
    crc_of_part(const std::string &path, const std::uint64_t begin, const std::uint64_t end)
    {
      std::ifstream in(path, std::ios::binary);
      in.seekg(begin);
      std::vector<char> buffer(1 << 20);
      uLong crc = crc32(0, nullptr, 0);
      for (std::uint64_t done = begin; done < end;)
        {
          const std::uint64_t n = std::min<std::uint64_t>(buffer.size(), end - done);
          if (!in.read(buffer.data(), n))
            throw std::runtime_error("cannot read '" + path + "'");
          crc = crc32(crc, reinterpret_cast<const Bytef *>(buffer.data()), n);
          done += n;
        }
      return crc;
    }


    // CRC-32 of all behind the header; every rank reads a stretch (collective).
    std::uint32_t
    crc_of_file(const std::string &path, const std::uint64_t size, const MPI_Comm comm)
    {
      const std::uint64_t n = n_mpi_processes(comm), rank = this_mpi_process(comm);
      const std::uint64_t length = size - checkpoint_header_size;
      const auto begin           = [&](const std::uint64_t part) {
        return checkpoint_header_size + length / n * part + std::min(part, length % n);
      };
      std::uint32_t crc = 0;
      std::string failure;
      try
        {
          crc = crc_of_part(path, begin(rank), begin(rank + 1));
        }
      catch (const std::exception &exception)
        {
          failure = exception.what();
        }
      for (const auto &of_rank : dealii::Utilities::MPI::all_gather(comm, failure))
        if (!of_rank.empty())
          throw std::runtime_error(of_rank);
      const auto parts = dealii::Utilities::MPI::all_gather(comm, crc);
      uLong all        = parts[0];
      for (std::uint64_t part = 1; part < n; ++part)
        all = crc32_combine(all, parts[part], begin(part + 1) - begin(part));
      return all;
    }


    // What the header says before the checksum.
    std::string
    description(const std::uint64_t size)
    {
      return std::string(magic) + "\nAkmon " AKMON_VERSION "\nformat " +
             std::to_string(checkpoint_format) + "\nbytes " + std::to_string(size) + "\n";
    }


    // The whole header; its checksum covers the description and all behind the header.
    std::string
    header(const std::string &description, const std::uint64_t size, const std::uint32_t crc_behind)
    {
      uLong crc = crc32(0, reinterpret_cast<const Bytef *>(description.data()), description.size());
      crc       = crc32_combine(crc, crc_behind, size - checkpoint_header_size);
      char line[32];
      std::snprintf(line, sizeof(line), "crc32 %08lx\n", crc);
      std::string text = description + line;
      text.resize(checkpoint_header_size, '\0');
      return text;
    }


    [[noreturn]] void
    fail(const std::string &what, const std::string &path)
    {
      throw std::runtime_error("cannot " + what + " '" + path + "': " + std::strerror(errno));
    }


    void
    sync(const std::string &path)
    {
      const int descriptor = open(path.c_str(), O_RDONLY);
      if (descriptor < 0)
        fail("open", path);
      const bool synced = fsync(descriptor) == 0;
      close(descriptor);
      if (!synced)
        fail("write", path);
    }


    // The message of what is wrong with a header; empty if nothing is.
    std::string
    fault_of_header(const std::string &text, const std::uint64_t size)
    {
      if (text.compare(0, std::strlen(magic), magic) != 0)
        return "this is no checkpoint of Akmon";
      std::smatch match;
      const std::string lines(text.c_str()); // up to the first zero
      if (!std::regex_search(lines, match, std::regex("\nAkmon (.*)\nformat (\\d{1,9})\n")))
        return "its header is damaged";
      if (std::stoul(match[2]) != checkpoint_format)
        return "it is of format " + match[2].str() + ", written by Akmon " + match[1].str() +
               "; this is Akmon " AKMON_VERSION ", which reads format " +
               std::to_string(checkpoint_format) + " only";
      if (!std::regex_search(lines, match, std::regex("\nbytes (\\d{1,18})\ncrc32 [0-9a-f]{8}\n$")))
        return "its header is damaged";
      if (std::stoull(match[1]) != size)
        return "it has " + std::to_string(size) + " bytes instead of " + match[1].str();
      return "";
    }
  } // namespace


  void
  seal_checkpoint(const std::string &temporary, const std::string &path, const MPI_Comm comm)
  {
    std::uint64_t size = 0;
    run_on_root(comm, [&]() { size = fs::file_size(temporary); });
    size                    = dealii::Utilities::MPI::broadcast(comm, size, 0);
    const std::uint32_t crc = crc_of_file(temporary, size, comm);
    run_on_root(comm, [&]() {
      std::FILE *const file  = std::fopen(temporary.c_str(), "r+b");
      const std::string text = header(description(size), size, crc);
      bool written           = file != nullptr &&
                     std::fwrite(text.data(), 1, text.size(), file) == text.size();
      if (file != nullptr)
        written = std::fclose(file) == 0 && written;
      if (!written)
        fail("write", temporary);
      sync(temporary);
      if (std::rename(temporary.c_str(), path.c_str()) != 0)
        fail("rename", temporary);
      sync(fs::path(path).parent_path().string());
    });
  }


  void
  verify_checkpoint(const std::string &path, const MPI_Comm comm)
  {
    std::string fault, text(checkpoint_header_size, '\0');
    std::uint64_t size = 0;
    if (this_mpi_process(comm) == 0)
      {
        std::error_code error;
        size = fs::file_size(path, error);
        std::ifstream in(path, std::ios::binary);
        if (error || !in)
          fault = "there is no such file, or it cannot be read";
        else if (size < checkpoint_header_size || !in.read(text.data(), text.size()))
          fault = "this is no checkpoint of Akmon";
        else
          fault = fault_of_header(text, size);
      }
    fault = dealii::Utilities::MPI::broadcast(comm, fault, 0);
    text  = dealii::Utilities::MPI::broadcast(comm, text, 0);
    size  = dealii::Utilities::MPI::broadcast(comm, size, 0);
    if (fault.empty())
      try
        {
          const std::string described = text.substr(0, text.find("crc32 "));
          if (text != header(described, size, crc_of_file(path, size, comm)))
            fault = "it is damaged: its bytes do not fit its checksum";
          else if (H5Fis_hdf5(path.c_str()) <= 0)
            fault = "there is no HDF5 file behind its header";
        }
      catch (const std::runtime_error &failure)
        {
          fault = failure.what();
        }
    if (!fault.empty())
      throw InputError("checkpoint '" + path + "' is refused: " + fault);
  }


  std::string
  checkpoint_path(const std::string &directory, const unsigned long step)
  {
    char name[48];
    std::snprintf(name, sizeof(name), "/checkpoint_%012lu.h5", step);
    return directory + name;
  }


  std::vector<std::string>
  list_checkpoints(const std::string &directory)
  {
    std::vector<std::string> paths;
    std::error_code error;
    for (fs::directory_iterator entry(directory, error), end; !error && entry != end;
         entry.increment(error))
      if (std::regex_match(entry->path().filename().string(), std::regex("checkpoint_\\d+\\.h5")))
        paths.push_back(entry->path().string());
    std::sort(paths.begin(), paths.end());
    return paths;
  }
} // namespace akmon
