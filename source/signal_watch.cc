#include <akmon/signal_watch.h>

#include <csignal>

namespace akmon
{
  namespace
  {
    // The one thing that a signal handler may touch.
    volatile std::sig_atomic_t last_request = SignalWatch::none;


    void
    take_notice(const int signal)
    {
      if (signal == SIGTERM)
        last_request = SignalWatch::stop;
      else if (last_request == SignalWatch::none)
        last_request = SignalWatch::checkpoint;
    }
  } // namespace


  SignalWatch::SignalWatch()
    : former_term(std::signal(SIGTERM, take_notice))
    , former_usr1(std::signal(SIGUSR1, take_notice))
  {
  }


  SignalWatch::~SignalWatch()
  {
    std::signal(SIGTERM, former_term);
    std::signal(SIGUSR1, former_usr1);
  }


  SignalWatch::Request
  SignalWatch::take()
  {
    const auto request = static_cast<Request>(last_request);
    last_request       = none;
    return request;
  }
} // namespace akmon
