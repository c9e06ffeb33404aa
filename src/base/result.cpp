#include "wisp/base/result.hpp"

#include <atomic>
#include <cstdio>
#include <cstdlib>

namespace wisp {
namespace {

void print_and_end(const char* sentence) {
  std::fprintf(stderr, "wisp: %s\n", sentence);
  std::abort();
}

std::atomic<MisuseHandler> handler_of_misuse = print_and_end;

}  // namespace

MisuseHandler set_misuse_handler(MisuseHandler handler) {
  return handler_of_misuse.exchange(handler ? handler : print_and_end);
}

void report_misuse(const char* sentence) { handler_of_misuse.load()(sentence); }

void end_on_misuse(const char* sentence) {
  report_misuse(sentence);
  std::abort();
}

bool check_size(const char* call, std::size_t found, std::size_t expected, bool or_more) {
  if (found == expected || (or_more && found > expected)) [[likely]]
    return true;
  char sentence[160];  // the frame path allocates nothing
  std::snprintf(sentence, sizeof sentence, "%s was given %zu numbers, expected %s%zu", call, found,
                or_more ? "at least " : "", expected);
  report_misuse(sentence);
  return false;
}

}  // namespace wisp
