// Steps many instances of a model, 100 000 by default, on all cores for two seconds' worth of frames, and prints the
// mean time of a frame. The library has no threads of its own: it uses those that the game lends to it.
//
//   11_crowd MODEL.wisp [INSTANCES [THREADS]]

#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <thread>
#include <vector>

#include "wisp/play.hpp"

// Threads that wait for work. The calling thread takes parts as well.
class Pool {
 public:
  explicit Pool(int threads) {
    for (int k = 1; k < threads; ++k) threads_.emplace_back([this] { work(); });
  }
  ~Pool() {
    {
      const std::lock_guard lock(mutex_);
      ends_ = true;
    }
    wake_.notify_all();
    for (std::thread& thread : threads_) thread.join();
  }

  static void run(void* pool, int parts, void (*task)(void*, int), void* of) {
    static_cast<Pool*>(pool)->run_all(parts, task, of);
  }

 private:
  struct Job {
    void (*task)(void*, int) = nullptr;
    void* of = nullptr;
    int parts = 0;
  };

  void run_all(int parts, void (*task)(void*, int), void* of) {
    std::unique_lock lock(mutex_);
    job_ = {task, of, parts};
    next_ = left_ = parts;
    wake_.notify_all();
    take_parts(lock);
    done_.wait(lock, [this] { return left_ == 0; });
  }

  // Executes parts until none is left. The lock is held at call and at return, and released during a part.
  void take_parts(std::unique_lock<std::mutex>& lock) {
    while (next_ > 0) {
      const Job job = job_;
      const int part = --next_;
      lock.unlock();
      job.task(job.of, part);
      lock.lock();
      if (--left_ == 0) done_.notify_all();
    }
  }

  void work() {
    std::unique_lock lock(mutex_);
    while (true) {
      wake_.wait(lock, [this] { return ends_ || next_ > 0; });
      if (ends_) return;
      take_parts(lock);
    }
  }

  std::mutex mutex_;
  std::condition_variable wake_, done_;
  Job job_;
  int next_ = 0;  // parts that nobody has taken
  int left_ = 0;  // parts that are not done
  bool ends_ = false;
  std::vector<std::thread> threads_;
};

int main(int argc, char** argv) {
  const auto model = wisp::read_model(argc > 1 ? argv[1] : "flame.wisp");
  if (!model) return std::puts(model.error().message.c_str()), 1;
  const int instances = argc > 2 ? std::atoi(argv[2]) : 100'000;
  const int cores = static_cast<int>(std::thread::hardware_concurrency());
  const int threads = argc > 3 ? std::atoi(argv[3]) : cores;
  auto bank = wisp::Bank::create(*model, {.capacity = instances});
  if (!bank) return std::puts(bank.error().message.c_str()), 1;
  for (int k = 0; k < instances; ++k) bank->spawn();

  Pool pool(threads);
  bank->set_crew({.parts = threads > 0 ? threads : 1, .run = Pool::run, .pool = &pool});
  constexpr int kFrames = 120;
  const auto start = std::chrono::steady_clock::now();
  for (int frame = 0; frame < kFrames; ++frame) bank->advance(std::chrono::nanoseconds(16'666'667));
  const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - start;
  std::printf("%d instances on %d threads: %.2f ms a frame\n", instances, threads, took.count() / kFrames);
}
