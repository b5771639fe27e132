#pragma once

#include <condition_variable>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>

namespace adamas::viewer {

/// A thread that does one piece of work at a time.
class WorkThread {
 public:
  WorkThread();
  /// Waits for the work that is being done.
  ~WorkThread();
  WorkThread(const WorkThread&) = delete;
  WorkThread& operator=(const WorkThread&) = delete;

  /// Begins some work, after the work that is being done.
  void begin(std::function<void()> work);
  /// Whether all work is done. Throws, once, what the work has thrown.
  [[nodiscard]] bool is_idle();

 private:
  void run();

  std::mutex mutex_;
  std::condition_variable changed_;
  std::function<void()> work_;  ///< empty where there is nothing to do
  std::exception_ptr thrown_;
  bool is_ended_ = false;
  std::thread thread_;
};

}  // namespace adamas::viewer
