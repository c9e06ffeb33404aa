#include "wisp/base/result.hpp"

#include <atomic>
#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace wisp {
namespace {

// In a page a trap ends the call with its stack; printing would be a tenth of the module.
[[noreturn]] void end_program() {
#ifdef __EMSCRIPTEN__
  __builtin_trap();
#else
  std::abort();
#endif
}

void print_and_end([[maybe_unused]] const char* sentence) {
#ifndef __EMSCRIPTEN__
  std::fprintf(stderr, "wisp: %s\n", sentence);
#endif
  end_program();
}

std::atomic<MisuseHandler> handler_of_misuse = print_and_end;

}  // namespace

MisuseHandler set_misuse_handler(MisuseHandler handler) {
  return handler_of_misuse.exchange(handler ? handler : print_and_end);
}

void report_misuse(const char* sentence) { handler_of_misuse.load()(sentence); }

void end_on_misuse(const char* sentence) {
  report_misuse(sentence);
  end_program();
}

bool check_size(const char* call, std::size_t found, std::size_t expected, bool or_more) {
  if (found == expected || (or_more && found > expected)) [[likely]]
    return true;
  char sentence[160] = "";  // the frame path allocates nothing
  const auto add = [&](std::size_t number) {
    char digits[24] = "";
    std::to_chars(digits, digits + 23, number);
    std::strcat(sentence, digits);
  };
  std::strncat(sentence, call, 80);
  std::strcat(sentence, " was given ");
  add(found);
  std::strcat(sentence, or_more ? " numbers, expected at least " : " numbers, expected ");
  add(expected);
  report_misuse(sentence);
  return false;
}

}  // namespace wisp
