#include <akmon/output/directory.h>
#include <akmon/output/pvd.h>

#include <deal.II/base/data_out_base.h>

#include <sstream>

namespace akmon
{
  PvdSeries::PvdSeries(const std::string &path, const MPI_Comm comm)
    : path(path)
    , comm(comm)
  {
  }


  std::vector<double>
  PvdSeries::times() const
  {
    std::vector<double> result;
    for (const auto &[time, file] : times_and_files)
      result.push_back(time);
    return result;
  }


  void
  PvdSeries::add(const double time, const std::string &vtu_file)
  {
    times_and_files.emplace_back(time, vtu_file);
    run_on_root(comm, [this]() {
      std::ostringstream content;
      dealii::DataOutBase::write_pvd_record(content, times_and_files);
      replace_file(path, content.str());
    });
  }
} // namespace akmon
