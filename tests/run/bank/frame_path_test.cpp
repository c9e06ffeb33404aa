// The frame path allocates nothing, takes no lock and makes no system call. Each guard is first shown to fire.

#include <dlfcn.h>
#include <gtest/gtest.h>
#include <pthread.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <mutex>
#include <new>
#include <optional>
#include <vector>

#include "model/sample_chain.hpp"
#include "model/sample_switched.hpp"
#include "paths.hpp"
#include "run/flame_model.hpp"
#include "wisp/model/file.hpp"
#include "wisp/run/bank.hpp"
#include "wisp/run/body_facet.hpp"
#include "wisp/run/chain_facet.hpp"
#include "wisp/run/extinction_facet.hpp"

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define WISP_SANITIZED 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define WISP_SANITIZED 1
#endif
#endif

namespace {

struct Counts {
  long allocations = 0;
  long locks = 0;
};
thread_local Counts counts;

// Not inlined: g++ would see malloc() meet delete, and warn of it.
[[gnu::noinline]] void* counted_allocation(std::size_t size, std::size_t alignment) {
  ++counts.allocations;
  const std::size_t rounded = (size + alignment - 1) / alignment * alignment;
  void* memory = alignment <= alignof(std::max_align_t) ? std::malloc(size) : std::aligned_alloc(alignment, rounded);
  if (!memory) std::abort();
  return memory;
}

}  // namespace

void* operator new(std::size_t size) { return counted_allocation(size, 1); }
void* operator new[](std::size_t size) { return counted_allocation(size, 1); }
void* operator new(std::size_t size, const std::nothrow_t&) noexcept { return counted_allocation(size, 1); }
void* operator new(std::size_t size, std::align_val_t alignment) {
  return counted_allocation(size, static_cast<std::size_t>(alignment));
}
void* operator new(std::size_t size, std::align_val_t alignment, const std::nothrow_t&) noexcept {
  return counted_allocation(size, static_cast<std::size_t>(alignment));
}
// Not inlined: GCC would see memory of operator new go to free() and warn, not knowing that both are replaced.
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete[](void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete[](void* memory, std::size_t) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::align_val_t) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }

#ifndef WISP_SANITIZED
// Every lock of the standard library on this platform ends here.
extern "C" int pthread_mutex_lock(pthread_mutex_t* mutex) noexcept {
  using Lock = int (*)(pthread_mutex_t*);
  static const auto own = reinterpret_cast<Lock>(dlsym(RTLD_NEXT, "pthread_mutex_lock"));
  ++counts.locks;
  return own(mutex);
}
#endif

namespace wisp {
namespace {

// A bank in given memory, and buffers for all that can be done with it each frame.
struct Stage {
  static constexpr int kCapacity = 20;

  explicit Stage(Model played = mortal_flame())
      : model(std::move(played)), memory(*bank_bytes(model, {.capacity = kCapacity})) {
    auto made = Bank::create(model, {.capacity = kCapacity, .memory = memory});
    EXPECT_TRUE(made);
    bank.emplace(std::move(made).value());
    for (int k = 0; k < kCapacity; ++k) bank->spawn();
    wind.assign(kCapacity * model.inputs.size(), 0.4f);
    outputs.resize(kCapacity * model.outputs.size());
    states.resize(kCapacity);
    polylines.resize(kCapacity * 2 * bank->polyline_points());
    saved.resize(bank->save_bytes());
    if (!bank->body()) return;
    rings.resize(kCapacity * static_cast<std::size_t>(bank->body()->rings()) * kRingNumbers);
  }

  // Every function of the frame path. `own` runs in the middle of it.
  template <class Own>
  void frame(Own own) {
    Bank& b = *bank;
    const InstanceId id = b.at(3);
    b.end(id);
    const InstanceId next = b.spawn();
    b.set_inputs(wind);
    b.set_common_inputs(std::span(wind).first(model.inputs.size()));
    b.set_inputs(next, std::span(wind).first(model.inputs.size()));
    b.set_noise(0.9f);
    if (ChainFacet* chain = b.chain()) {
      chain->set_ground(-0.1f);
    }
    b.step();
    own();
    b.advance(std::chrono::nanoseconds(70'000'000));
    b.outputs(outputs);
    b.outputs(next, std::span(outputs).first(model.outputs.size()));
    if (b.polyline_points() > 0) {
      b.polylines(polylines);
      b.polyline(next, std::span(polylines).first(2 * b.polyline_points()));
    }
    if (ChainFacet* chain = b.chain()) {
      chain->place(next, {.position = {0, 0, 0.02f}, .velocity = {0, 0.2f, -1}});
      chain->place_of(next);
      chain->steer(b.at(0), {.position = {1, 0, -1}, .in = std::chrono::seconds(2)});
      chain->release(b.at(1));
    }
    if (BodyFacet* body = b.body()) {
      body->look(0.6f, -0.8f);
      body->read_rings(rings);
    }
    b.mode(next);
    if (ExtinctionFacet* extinction = b.extinction()) {
      extinction->extinguish(next);
      extinction->states(states);
      extinction->relight(next);
    }
    b.save(saved);
    if (!b.restore(saved)) std::abort();
    b.reset(next);
    b.reset();
  }
  void frame() {
    frame([] {});
  }

  static Model mortal_flame() {
    Model flame = flame_model({.wind = InputShape::kEvenOdd, .resampled_rows = 300});
    flame.extinction.emplace();
    return flame;
  }

  // One of every kind of dynamics, and of every way to switch.
  static std::vector<Model> models() {
    const auto shaped = read_model(WISP_SOURCE_DIR "/apps/web/public/models/flame.wisp");
    return {mortal_flame(), still_flame_model(), windy_chain(), sample_switched(), *in_the_round(*shaped)};
  }

  Model model;
  std::vector<std::byte> memory;
  std::optional<Bank> bank;
  std::vector<LitState> states;
  std::vector<float> wind, outputs, polylines, rings;
  std::vector<std::byte> saved;
};

TEST(FramePath, TheGuardSeesAnAllocation) {
  Stage stage;
  counts = {};
  stage.frame([] { delete new volatile int(1); });
  EXPECT_EQ(counts.allocations, 1);
}

TEST(FramePath, AllocatesNothing) {
  for (const Model& model : Stage::models()) {
    Stage stage(model);
    counts = {};
    for (int k = 0; k < 100; ++k) stage.frame();
    EXPECT_EQ(counts.allocations, 0) << model.name;
  }
}

TEST(FramePath, ABankThatOwnsItsMemoryAllocatesItOnce) {
  const Model model = flame_model();
  std::vector<std::byte> memory(*bank_bytes(model, {.capacity = 100}));
  counts = {};
  ASSERT_TRUE(Bank::create(model, {.capacity = 100, .memory = memory}));
  const long compiling = counts.allocations;  // what creating takes for a while wherever the bank lives
  counts = {};
  auto bank = Bank::create(model, {.capacity = 100});
  EXPECT_EQ(counts.allocations, compiling + 1);
}

#ifndef WISP_SANITIZED
TEST(FramePath, TheGuardSeesALock) {
  Stage stage;
  std::mutex mutex;
  counts = {};
  stage.frame([&] { std::lock_guard hold(mutex); });
  EXPECT_EQ(counts.locks, 1);
}

TEST(FramePath, TakesNoLock) {
  for (const Model& model : Stage::models()) {
    Stage stage(model);
    counts = {};
    for (int k = 0; k < 100; ++k) stage.frame();
    EXPECT_EQ(counts.locks, 0) << model.name;
  }
}

// Runs frames where the kernel ends the process at any system call but read, write and exit. Returns how it ended.
template <class Own>
int status_of_sealed_frames(Own own, const Model& model = Stage::mortal_flame()) {
  Stage stage(model);
  const pid_t child = fork();
  if (child == 0) {
    if (prctl(PR_SET_SECCOMP, 1) != 0) _exit(77);  // 1: strict
    for (int k = 0; k < 100; ++k) stage.frame(own);
    syscall(SYS_exit, 0);
  }
  int status = 0;
  waitpid(child, &status, 0);
  return status;
}

TEST(FramePath, TheGuardSeesASystemCall) {
  const int status = status_of_sealed_frames([] { syscall(SYS_getpid); });
  if (WIFEXITED(status) && WEXITSTATUS(status) == 77) GTEST_SKIP() << "this kernel does not seal processes (seccomp)";
  ASSERT_TRUE(WIFSIGNALED(status));
  EXPECT_EQ(WTERMSIG(status), SIGKILL);
}

TEST(FramePath, MakesNoSystemCall) {
  for (const Model& model : Stage::models()) {
    const int status = status_of_sealed_frames([] {}, model);
    if (WIFEXITED(status) && WEXITSTATUS(status) == 77) GTEST_SKIP() << "this kernel does not seal processes (seccomp)";
    ASSERT_TRUE(WIFEXITED(status)) << "ended by signal " << WTERMSIG(status);
    EXPECT_EQ(WEXITSTATUS(status), 0);
  }
}
#endif

}  // namespace
}  // namespace wisp
