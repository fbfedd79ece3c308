#include <akmon/checkpoint/checkpoint_file.h>
#include <akmon/checkpoint/restart.h>
#include <akmon/parameters.h>

#include <filesystem>

namespace akmon
{
  namespace fs = std::filesystem;

  Restart
  find_restart(const std::string &place, std::vector<std::string> overrides)
  {
    fs::path directory = place, checkpoint = place;
    if (!fs::exists(place))
      throw InputError("--restart " + place + ": there is no such directory or checkpoint");
    if (fs::is_directory(place))
      {
        const auto checkpoints = list_checkpoints(place);
        if (checkpoints.empty())
          throw InputError("--restart " + place + ": there is no checkpoint in this directory");
        checkpoint = checkpoints.back();
      }
    else
      directory = checkpoint.has_parent_path() ? checkpoint.parent_path() : fs::path(".");
    // The directory may have been moved since.
    overrides.push_back("Output directory=" + directory.string());
    return {(directory / "parameters.prm").string(), overrides, checkpoint.string()};
  }
} // namespace akmon
