#include <akmon/case.h>
#include <akmon/checkpoint/restart.h>
#include <akmon/exit_status.h>
#include <akmon/parameters.h>
#include <akmon/signal_watch.h>
#include <akmon/simulation.h>

#include <deal.II/base/mpi.h>

#include <chrono>
#include <cstdlib>
#include <iostream>
#include <regex>
#include <thread>

namespace
{
  const char *const usage =
    "usage: akmon FILE.prm [--set \"Section/Sub/Key=value\"]...   run a case\n"
    "       akmon --restart DIRECTORY|CHECKPOINT [--set ...]...  go on with the run in DIRECTORY\n"
    "       akmon --validate FILE.prm [--set ...]...             check a case without running it\n"
    "       akmon --print-parameters                             every parameter and its meaning\n"
    "       akmon --help | --version\n";

  struct Arguments
  {
    std::string file;
    std::string restart; // directory or checkpoint
    std::vector<std::string> overrides;
    bool validate = false, print_parameters = false, help = false, version = false;
  };


  Arguments
  read_arguments(const int argc, char **argv)
  {
    Arguments arguments;
    for (int i = 1; i < argc; ++i)
      {
        const std::string argument = argv[i];
        if (argument == "--set" && i + 1 < argc)
          arguments.overrides.emplace_back(argv[++i]);
        else if (argument == "--set")
          throw akmon::InputError("--set needs \"Section/Sub/Key=value\" after it");
        else if (argument == "--restart" && i + 1 < argc)
          arguments.restart = argv[++i];
        else if (argument == "--restart")
          throw akmon::InputError("--restart needs the directory of a run after it");
        else if (argument == "--validate")
          arguments.validate = true;
        else if (argument == "--print-parameters")
          arguments.print_parameters = true;
        else if (argument == "--help")
          arguments.help = true;
        else if (argument == "--version")
          arguments.version = true;
        else if (argument[0] != '-' && arguments.file.empty())
          arguments.file = argument;
        else
          throw akmon::InputError("argument '" + argument +
                                  "' is not understood; see akmon --help");
      }
    if (!arguments.restart.empty() && !arguments.file.empty())
      throw akmon::InputError("--restart goes on with the parameters.prm in its directory; '" +
                              arguments.file + "' is one too many");
    if (arguments.file.empty() && arguments.restart.empty() && !arguments.print_parameters &&
        !arguments.help && !arguments.version)
      throw akmon::InputError("a parameter file is missing; see akmon --help");
    return arguments;
  }


  void
  run_case(const akmon::Restart &start, const bool only_validate, const bool root)
  {
    try
      {
        const auto parameters = akmon::Case::read(start.file, start.overrides);
        if (only_validate)
          {
            akmon::Simulation(parameters, MPI_COMM_WORLD).warn_of_oddities();
            if (root)
              std::cout << start.file << " is valid\n";
            return;
          }
        const akmon::SignalWatch signals; // while a part of the run gives way to the next one, too
        akmon::Continuation next;
        next.checkpoint = start.checkpoint;
        do
          next = akmon::Simulation(parameters, MPI_COMM_WORLD, false, next).run(next.checkpoint);
        while (!next.checkpoint.empty());
      }
    catch (const akmon::InputError &error)
      {
        throw akmon::InputError(start.file + ": " + error.what());
      }
  }


  void
  run(const Arguments &arguments, const bool root)
  {
    if (arguments.help && root)
      std::cout << usage;
    else if (arguments.version && root)
      std::cout << "akmon " AKMON_VERSION "\n";
    else if (arguments.print_parameters && root)
      akmon::Case::print_reference(std::cout);
    if (!arguments.restart.empty())
      run_case(akmon::find_restart(arguments.restart, arguments.overrides),
               arguments.validate,
               root);
    else if (!arguments.file.empty())
      run_case({arguments.file, arguments.overrides, ""}, arguments.validate, root);
  }


  // Whether all ranks get here. Input and run errors are raised on all ranks alike; others, such as
  // too little memory, may stop one rank while the others wait for it.
  bool
  all_ranks_fail(const MPI_Comm communicator)
  {
    MPI_Request request;
    int all = 0;
    MPI_Ibarrier(communicator, &request);
    for (unsigned int tenth_of_second = 0; tenth_of_second < 100 && !all; ++tenth_of_second)
      {
        MPI_Test(&request, &all, MPI_STATUS_IGNORE);
        if (!all)
          std::this_thread::sleep_for(std::chrono::milliseconds(tenth_of_second == 0 ? 1 : 100));
      }
    return all;
  }


  // Open MPI gives every file it opens a shared file pointer, in a semaphore of /dev/shm under the
  // file's name without its directory. One that a killed run leaves taken makes every later run
  // that writes a file of this name wait for ever. No file of ours is written through a shared
  // pointer: keep to the only kind that makes nothing of the sort before it is used. Other MPI
  // libraries do not know this variable; what the user has set stays.
  void
  avoid_shared_file_pointers()
  {
    setenv("OMPI_MCA_sharedfp", "individual", 0);
  }


  void
  report(const std::string &error)
  {
    std::cerr << "akmon: error: " + std::regex_replace(error, std::regex("\\s*\n\\s*"), " ") + "\n"
              << std::flush;
  }
} // namespace


int
main(int argc, char **argv)
{
  avoid_shared_file_pointers();
  const dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  const bool root = dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0;
  MPI_Comm for_errors;
  MPI_Comm_dup(MPI_COMM_WORLD, &for_errors);
  int status           = static_cast<int>(akmon::ExitStatus::done);
  const auto fail_with = [&](const akmon::ExitStatus failure, const std::string &error) {
    status         = static_cast<int>(failure);
    const bool all = all_ranks_fail(for_errors);
    if (root || !all)
      report(error);
    if (!all)
      MPI_Abort(MPI_COMM_WORLD, status);
  };
  try
    {
      run(read_arguments(argc, argv), root);
    }
  catch (const akmon::InputError &error)
    {
      fail_with(akmon::ExitStatus::bad_input, error.what());
    }
  catch (const akmon::RunError &error)
    {
      fail_with(error.status, error.what());
    }
  catch (const std::exception &error)
    {
      fail_with(akmon::ExitStatus::unexpected_error, error.what());
    }
  MPI_Comm_free(&for_errors);
  return status;
}
