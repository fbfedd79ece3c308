#include <akmon/exit_status.h>
#include <akmon/output/directory.h>
#include <akmon/parameters.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <regex>
#include <stdexcept>
#include <vector>

namespace akmon
{
  namespace
  {
    namespace fs = std::filesystem;

    // What replace_file() writes before it moves the file to its name.
    const std::string temporary_suffix = ".tmp";


    bool
    starts_with(const std::string &text, const std::string &start)
    {
      return text.compare(0, start.size(), start) == 0;
    }


    bool
    ends_with(const std::string &text, const std::string &end)
    {
      return text.size() >= end.size() &&
             text.compare(text.size() - end.size(), end.size(), end) == 0;
    }


    bool
    is_own_result(const std::string &name)
    {
      for (const std::string own :
           {"fields.pvd", "history.csv", "contact.csv", "summary.json", "parameters.prm"})
        if (name == own || name == own + temporary_suffix)
          return true;
      return (starts_with(name, "fields_") && ends_with(name, ".vtu")) ||
             starts_with(name, "checkpoint");
    }


    void
    remove_old_results(const fs::path &directory)
    {
      // Collect first: removing while iterating leaves it open which entries the iterator visits.
      std::vector<fs::path> old_results;
      for (const auto &entry : fs::directory_iterator(directory))
        if (is_own_result(entry.path().filename().string()))
          old_results.push_back(entry.path());
      for (const auto &file : old_results)
        fs::remove_all(file);
    }


    void
    create_writable(const fs::path &directory)
    {
      std::error_code error;
      fs::create_directories(directory, error);
      if (error)
        throw std::runtime_error(error.message());
      // Permission bits do not tell about read-only or full file systems; writing does.
      const fs::path probe = directory / ".akmon_probe";
      replace_file(probe.string(), "probe\n");
      fs::remove(probe);
    }
  } // namespace


  void
  prepare_output_directory(const std::string &path, const MPI_Comm comm)
  {
    try
      {
        run_on_root(comm, [&path]() {
          create_writable(path);
          remove_old_results(path);
        });
      }
    catch (const std::runtime_error &failure)
      {
        throw InputError("output directory '" + path + "' cannot be written: " + failure.what());
      }
  }


  void
  remove_results_behind(const std::string &path,
                        const unsigned long step,
                        const std::size_t n_field_files,
                        const MPI_Comm comm)
  {
    run_on_root(comm, [&]() {
      std::vector<fs::path> stale;
      for (const auto &entry : fs::directory_iterator(path))
        {
          const std::string name = entry.path().filename().string();
          std::smatch match;
          if (std::regex_match(name, match, std::regex("checkpoint_(\\d{1,18})\\.h5")) ?
                std::stoul(match[1]) > step :
              std::regex_match(name, match, std::regex("fields_(\\d{1,18})\\.vtu")) ?
                std::stoul(match[1]) >= n_field_files :
                is_own_result(name) &&
                  (ends_with(name, temporary_suffix) || starts_with(name, "checkpoint")))
            stale.push_back(entry.path());
        }
      for (const auto &file : stale)
        fs::remove(file);
    });
  }


  void
  run_on_root(const MPI_Comm comm, const std::function<void()> &task)
  {
    std::string failure;
    if (dealii::Utilities::MPI::this_mpi_process(comm) == 0)
      try
        {
          task();
        }
      catch (const std::exception &exception)
        {
          failure = exception.what();
        }
    failure = dealii::Utilities::MPI::broadcast(comm, failure, 0);
    if (!failure.empty())
      throw RunError(ExitStatus::output_failed, failure);
  }


  void
  replace_file(const std::string &path, const std::string &content)
  {
    const std::string temporary = path + temporary_suffix;
    const auto fail             = [&path, &temporary](const int reason) {
      std::remove(temporary.c_str());
      throw std::runtime_error("cannot write '" + path + "': " + std::strerror(reason));
    };

    std::FILE *file = std::fopen(temporary.c_str(), "wb");
    if (file == nullptr)
      fail(errno);
    // A full disk may show only when the buffer is flushed, so that result counts as well.
    const bool written = std::fwrite(content.data(), 1, content.size(), file) == content.size() &&
                         std::fflush(file) == 0;
    const int reason  = errno;
    const bool closed = std::fclose(file) == 0;
    if (!written || !closed)
      fail(written ? errno : reason);
    if (std::rename(temporary.c_str(), path.c_str()) != 0)
      fail(errno);
  }
} // namespace akmon
