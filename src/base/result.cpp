#include "wisp/base/result.hpp"

#include <algorithm>
#include <atomic>
#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <string_view>

namespace wisp {
namespace {

#ifdef __EMSCRIPTEN__
// A trap ends the call with its stack; code that prints would make up a tenth of the WebAssembly module.
[[noreturn]] void print_and_end(const char*) { __builtin_trap(); }
#else
[[noreturn]] void print_and_end(const char* sentence) {
  std::fprintf(stderr, "wisp: %s\n", sentence);
  std::abort();
}
#endif

std::atomic<MisuseHandler> handler_of_misuse = print_and_end;

}  // namespace

MisuseHandler set_misuse_handler(MisuseHandler handler) {
  return handler_of_misuse.exchange(handler ? handler : print_and_end);
}

void report_misuse(const char* sentence) { handler_of_misuse.load()(sentence); }

void end_on_misuse(const char* sentence) {
  report_misuse(sentence);
  print_and_end(sentence);  // if the handler returned
}

bool check_size(const char* call, std::size_t found, std::size_t expected, bool or_more) {
  if (found == expected || (or_more && found > expected)) [[likely]]
    return true;
  char sentence[160];  // no allocation: calls made in every frame are checked too
  char* end = sentence;
  const auto say = [&end](std::string_view words) { end = std::copy_n(words.data(), words.size(), end); };
  say(std::string_view(call).substr(0, 80));
  say(" was given ");
  end = std::to_chars(end, end + 20, found).ptr;
  say(or_more ? " numbers, expected at least " : " numbers, expected ");
  *std::to_chars(end, end + 20, expected).ptr = '\0';
  report_misuse(sentence);
  return false;
}

}  // namespace wisp
