#include <akmon/checkpoint/checkpoint.h>
#include <akmon/checkpoint/checkpoint_file.h>
#include <akmon/output/directory.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <stdexcept>
#include <unistd.h>

namespace akmon
{
  namespace
  {
    using dealii::Utilities::MPI::n_mpi_processes;
    using dealii::Utilities::MPI::this_mpi_process;

    constexpr std::size_t slab_bytes     = 1 << 22; ///< of a table, in memory at a time
    constexpr std::size_t metadata_bytes = 1 << 16; ///< more than HDF5 adds around a table


    // Of a table with so many columns, one at least.
    std::size_t
    rows_at_a_time(const std::size_t width)
    {
      return std::max<std::size_t>(1,
                                   slab_bytes / std::max<std::size_t>(1, width * sizeof(double)));
    }


    hid_t
    file_access(const MPI_Comm comm)
    {
      const hid_t access = H5Pcreate(H5P_FILE_ACCESS);
      if (n_mpi_processes(comm) > 1)
        H5Pset_fapl_mpio(access, comm, MPI_INFO_NULL);
      return access;
    }


    Hdf5Id
    create_file(const std::string &path, const MPI_Comm comm)
    {
      silence_hdf5();
      const Hdf5Id access(file_access(comm), H5Pclose, "cannot set up HDF5");
      const Hdf5Id creation(H5Pcreate(H5P_FILE_CREATE), H5Pclose, "cannot set up HDF5");
      check_hdf5(H5Pset_userblock(creation, checkpoint_header_size), "cannot set up HDF5");
      check_hdf5(H5Pset_obj_track_times(creation, false), "cannot set up HDF5");
      return {H5Fcreate(path.c_str(), H5F_ACC_TRUNC, creation, access),
              H5Fclose,
              "cannot write '" + path + "'"};
    }


    Hdf5Id
    open_file(const std::string &path)
    {
      silence_hdf5();
      return {H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT),
              H5Fclose,
              "cannot read '" + path + "'"};
    }


    // Raises an error of any rank on all of them.
    void
    agree_on_success(const std::string &failure, const MPI_Comm comm)
    {
      for (const auto &of_rank : dealii::Utilities::MPI::all_gather(comm, failure))
        if (!of_rank.empty())
          throw std::runtime_error(of_rank);
    }
  } // namespace


  CheckpointWriter::CheckpointWriter(const std::string &path, const MPI_Comm comm)
    : path(path)
    , temporary(path + ".tmp")
    , comm(comm)
    , file([&]() {
      // HDF5 says little about why it cannot create a file; the operating system does.
      run_on_root(comm, [&]() { replace_file(path + ".tmp", ""); });
      return create_file(path + ".tmp", comm);
    }())
  {
  }


  CheckpointWriter::~CheckpointWriter()
  {
    if (!finished && this_mpi_process(comm) == 0)
      std::remove(temporary.c_str());
  }


  void
  CheckpointWriter::numbers(const std::string &name, const std::vector<double> &values)
  {
    table(name, this_mpi_process(comm) == 0 ? values.size() : 0, 1, [&](const auto row, double *x) {
      *x = values[row];
    });
  }


  void
  CheckpointWriter::integer(const std::string &name, const std::uint64_t value)
  {
    const std::string what = "cannot write " + name + " into '" + temporary + "'";
    reserve_space(0);
    const Hdf5Id space(H5Screate(H5S_SCALAR), H5Sclose, what);
    const Hdf5Id
      attribute(H5Acreate2(file, name.c_str(), H5T_STD_U64LE, space, H5P_DEFAULT, H5P_DEFAULT),
                H5Aclose,
                what);
    const std::uint64_t of_root = dealii::Utilities::MPI::broadcast(comm, value, 0);
    check_hdf5(H5Awrite(attribute, H5T_NATIVE_UINT64, &of_root), what);
  }


  void
  CheckpointWriter::text(const std::string &name, const std::string &value)
  {
    const std::string of_root = dealii::Utilities::MPI::broadcast(comm, value, 0);
    const std::string what    = "cannot write " + name + " into '" + temporary + "'";
    reserve_space(of_root.size());
    const Hdf5Id type(H5Tcopy(H5T_C_S1), H5Tclose, what);
    check_hdf5(H5Tset_size(type, of_root.size() + 1), what);
    const Hdf5Id space(H5Screate(H5S_SCALAR), H5Sclose, what);
    const Hdf5Id attribute(H5Acreate2(file, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT),
                           H5Aclose,
                           what);
    check_hdf5(H5Awrite(attribute, type, of_root.c_str()), what);
  }


  void
  CheckpointWriter::part_of_rank(const std::string &name, const std::vector<double> &values)
  {
    table(name, 1, values.size(), [&](const auto, double *const row) {
      std::copy(values.begin(), values.end(), row);
    });
  }


  void
  CheckpointWriter::table(const std::string &name,
                          const std::size_t n_rows,
                          const std::size_t width,
                          const FillRow &fill)
  {
    const std::string what      = "cannot write " + name + " into '" + temporary + "'";
    const auto counts           = dealii::Utilities::MPI::all_gather(comm, std::uint64_t(n_rows));
    const std::size_t me        = this_mpi_process(comm);
    std::array<hsize_t, 2> size = {{0, width}}, start = {{0, 0}};
    for (std::size_t rank = 0; rank < counts.size(); ++rank)
      {
        size[0] += counts[rank];
        start[0] += rank < me ? counts[rank] : 0;
      }
    reserve_space(size[0] * width * sizeof(double));
    const Hdf5Id space(H5Screate_simple(2, size.data(), nullptr), H5Sclose, what);
    const Hdf5Id creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, what);
    // Equal states make equal files.
    check_hdf5(H5Pset_obj_track_times(creation, false), what);
    check_hdf5(H5Pset_alloc_time(creation, H5D_ALLOC_TIME_EARLY), what);
    check_hdf5(H5Pset_fill_time(creation, H5D_FILL_TIME_NEVER), what);
    const Hdf5Id dataset(
      H5Dcreate2(file, name.c_str(), H5T_IEEE_F64LE, space, H5P_DEFAULT, creation, H5P_DEFAULT),
      H5Dclose,
      what);
    if (size[0] == 0 || width == 0)
      return;

    const Hdf5Id transfer(H5Pcreate(H5P_DATASET_XFER), H5Pclose, what);
    if (counts.size() > 1)
      check_hdf5(H5Pset_dxpl_mpio(transfer, H5FD_MPIO_COLLECTIVE), what);
    const std::size_t slab   = rows_at_a_time(width);
    const std::size_t rounds = (*std::max_element(counts.begin(), counts.end()) + slab - 1) / slab;
    std::vector<double> values;
    std::string failure;
    for (std::size_t round = 0, row = 0; round < rounds; ++round)
      {
        std::array<hsize_t, 2> n = {{std::min(slab, n_rows - row), width}};
        values.resize(std::max<std::size_t>(1, n[0] * width));
        for (std::size_t i = 0; i < n[0]; ++i)
          fill(row + i, values.data() + i * width);
        const Hdf5Id memory(H5Screate_simple(2, n.data(), nullptr), H5Sclose, what);
        if (n[0] == 0)
          {
            H5Sselect_none(space);
            H5Sselect_none(memory);
          }
        else
          H5Sselect_hyperslab(space, H5S_SELECT_SET, start.data(), nullptr, n.data(), nullptr);
        if (failure.empty() &&
            H5Dwrite(dataset, H5T_NATIVE_DOUBLE, memory, space, transfer, values.data()) < 0)
          failure = what;
        row += n[0];
        start[0] += n[0];
      }
    agree_on_success(failure, comm);
  }


  // Ask the file system for the space of what comes next, metadata included, before HDF5 knows of
  // it: a full disk then shows while nothing is lost. HDF5 itself does not survive it; a file that
  // it fails to close is freed twice at the end of the program.
  void
  CheckpointWriter::reserve_space(const std::uint64_t n_bytes)
  {
    reserved += n_bytes + metadata_bytes;
    run_on_root(comm, [&]() {
      const int descriptor = open(temporary.c_str(), O_WRONLY);
      const int error      = descriptor < 0 ? errno : posix_fallocate(descriptor, 0, reserved);
      if (descriptor >= 0)
        close(descriptor);
      if (error != 0)
        throw std::runtime_error("cannot write '" + path + "': " + std::strerror(error));
    });
  }


  // What was reserved and not used is cut off, or stays at the end, which readers do not mind.
  void
  CheckpointWriter::finish()
  {
    std::string failure;
    try
      {
        check_hdf5(H5Fflush(file, H5F_SCOPE_GLOBAL), "cannot write '" + path + "'");
        file.close();
      }
    catch (const std::runtime_error &error)
      {
        failure = error.what();
      }
    agree_on_success(failure, comm);
    seal_checkpoint(temporary, path, comm);
    finished = true;
  }


  CheckpointReader::CheckpointReader(const std::string &path)
    : file(open_file(path))
  {
  }


  std::vector<double>
  CheckpointReader::numbers(const std::string &name) const
  {
    std::vector<double> values;
    rows(name, 0, size(name).first, [&](const auto, const double *const value) {
      values.push_back(*value);
    });
    return values;
  }


  std::uint64_t
  CheckpointReader::integer(const std::string &name) const
  {
    const std::string what = "cannot read " + name;
    const Hdf5Id attribute(H5Aopen(file, name.c_str(), H5P_DEFAULT), H5Aclose, what);
    std::uint64_t value = 0;
    check_hdf5(H5Aread(attribute, H5T_NATIVE_UINT64, &value), what);
    return value;
  }


  std::string
  CheckpointReader::text(const std::string &name) const
  {
    const std::string what = "cannot read " + name;
    const Hdf5Id attribute(H5Aopen(file, name.c_str(), H5P_DEFAULT), H5Aclose, what);
    const Hdf5Id type(H5Aget_type(attribute), H5Tclose, what);
    std::string value(H5Tget_size(type), '\0');
    check_hdf5(H5Aread(attribute, type, value.data()), what);
    return value.c_str();
  }


  std::vector<double>
  CheckpointReader::sum_of_rank(const std::string &name, const MPI_Comm comm) const
  {
    const auto [n_ranks, width] = size(name);
    const std::size_t me        = this_mpi_process(comm);
    const bool as_then          = n_ranks == n_mpi_processes(comm);
    if (!as_then && me > 0)
      return std::vector<double>(width, 0.);
    std::vector<double> values(width, -0.); // what is added to it keeps its bits
    rows(name, as_then ? me : 0, as_then ? me + 1 : n_ranks, [&](const auto, const double *part) {
      for (std::size_t i = 0; i < values.size(); ++i)
        values[i] += part[i];
    });
    return values;
  }


  std::pair<std::size_t, std::size_t>
  CheckpointReader::size(const std::string &name) const
  {
    const std::string what = "cannot read " + name;
    const Hdf5Id dataset(H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose, what);
    const Hdf5Id space(H5Dget_space(dataset), H5Sclose, what);
    std::array<hsize_t, 2> size = {{0, 0}};
    if (H5Sget_simple_extent_ndims(space) != 2)
      throw std::runtime_error(what + ": it is no table");
    H5Sget_simple_extent_dims(space, size.data(), nullptr);
    return {size[0], size[1]};
  }


  void
  CheckpointReader::rows(const std::string &name,
                         const std::size_t begin,
                         const std::size_t end,
                         const TakeRow &take) const
  {
    const std::string what  = "cannot read " + name;
    const std::size_t width = size(name).second;
    const Hdf5Id dataset(H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose, what);
    const Hdf5Id space(H5Dget_space(dataset), H5Sclose, what);
    const std::size_t slab = rows_at_a_time(width);
    std::vector<double> values;
    for (std::size_t row = begin; row < end;)
      {
        const std::array<hsize_t, 2> start = {{row, 0}}, n = {{std::min(slab, end - row), width}};
        values.resize(n[0] * width);
        const Hdf5Id memory(H5Screate_simple(2, n.data(), nullptr), H5Sclose, what);
        check_hdf5(H5Sselect_hyperslab(space,
                                       H5S_SELECT_SET,
                                       start.data(),
                                       nullptr,
                                       n.data(),
                                       nullptr),
                   what);
        check_hdf5(H5Dread(dataset, H5T_NATIVE_DOUBLE, memory, space, H5P_DEFAULT, values.data()),
                   what);
        for (std::size_t i = 0; i < n[0]; ++i)
          take(row + i, values.data() + i * width);
        row += n[0];
      }
  }
} // namespace akmon
