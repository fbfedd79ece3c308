#pragma once

#include <deal.II/base/mpi.h>

#include <hdf5.h>
#include <string>

namespace akmon
{
  /**
   * An HDF5 identifier that closes itself. HDF5's C interface and not deal.II's classes, which
   * check for errors in debug builds only: a full disk must be noticed.
   */
  class Hdf5Id
  {
  public:
    using Close = herr_t (*)(hid_t);

    /// Throws std::runtime_error, with what HDF5 says, if the identifier is not valid.
    Hdf5Id(const hid_t id, const Close close, const std::string &what);
    ~Hdf5Id();
    Hdf5Id(Hdf5Id &&other) noexcept;
    Hdf5Id(const Hdf5Id &) = delete;
    Hdf5Id &
    operator=(const Hdf5Id &) = delete;

    operator hid_t() const
    {
      return id;
    }

    /// Close now, with errors noticed. Throws std::runtime_error.
    void
    close();

  private:
    hid_t id;
    Close closer;
    std::string what;
  };

  /// Throws std::runtime_error, with what HDF5 says, for a negative result.
  void
  check_hdf5(const herr_t result, const std::string &what);

  /// From here on HDF5 tells errors by return values only and does nothing when the program ends
  /// (a file it could not write would be tried again).
  void
  silence_hdf5();
} // namespace akmon
