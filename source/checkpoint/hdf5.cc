#include <akmon/checkpoint/hdf5.h>

#include <stdexcept>
#include <utility>

namespace akmon
{
  namespace
  {
    // The innermost entry of HDF5's error stack, which names the cause.
    std::string
    hdf5_reason()
    {
      std::string reason;
      const auto note = [](const unsigned int, const H5E_error2_t *error, void *text) -> herr_t {
        if (error->desc != nullptr && static_cast<std::string *>(text)->empty())
          *static_cast<std::string *>(text) = error->desc;
        return 0;
      };
      H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, note, &reason);
      return reason.empty() ? "" : ": " + reason;
    }
  } // namespace


  Hdf5Id::Hdf5Id(const hid_t id, const Close close, const std::string &what)
    : id(id)
    , closer(close)
    , what(what)
  {
    if (id < 0)
      throw std::runtime_error(what + hdf5_reason());
  }


  Hdf5Id::~Hdf5Id()
  {
    if (id >= 0)
      closer(id);
  }


  Hdf5Id::Hdf5Id(Hdf5Id &&other) noexcept
    : id(std::exchange(other.id, -1))
    , closer(other.closer)
    , what(std::move(other.what))
  {
  }


  void
  Hdf5Id::close()
  {
    check_hdf5(closer(std::exchange(id, -1)), what);
  }


  void
  check_hdf5(const herr_t result, const std::string &what)
  {
    if (result < 0)
      throw std::runtime_error(what + hdf5_reason());
  }


  void
  silence_hdf5()
  {
    H5dont_atexit();
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  }
} // namespace akmon
