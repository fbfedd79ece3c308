#pragma once

namespace akmon
{
  /**
   * Takes notice of SIGTERM and SIGUSR1 while it lives; both then no longer end the process. One
   * object at a time.
   */
  class SignalWatch
  {
  public:
    SignalWatch();
    ~SignalWatch();
    SignalWatch(const SignalWatch &) = delete;
    SignalWatch &
    operator=(const SignalWatch &) = delete;

    enum Request
    {
      none,
      checkpoint, ///< SIGUSR1: write a checkpoint and go on
      stop        ///< SIGTERM: write a checkpoint and stop
    };

    /// The strongest request this process got since the last call.
    Request
    take();

  private:
    using Handler = void (*)(int);
    Handler former_term, former_usr1;
  };
} // namespace akmon
