#include "answer.hpp"

namespace wisp::studio {

Answer& answer() {
  static Answer the;
  return the;
}

Answer& fresh() {
  answer() = {};
  return answer();
}

int fail(const Error& error) {
  fresh().text = error.message;
  return kFailed;
}

}  // namespace wisp::studio

using wisp::studio::answer;

extern "C" {
__attribute__((export_name("studio_text"))) const char* studio_text() { return answer().text.data(); }
__attribute__((export_name("studio_text_size"))) std::size_t studio_text_size() { return answer().text.size(); }
__attribute__((export_name("studio_bytes"))) const std::byte* studio_bytes() { return answer().bytes.data(); }
__attribute__((export_name("studio_bytes_size"))) std::size_t studio_bytes_size() { return answer().bytes.size(); }
__attribute__((export_name("studio_numbers"))) const double* studio_numbers() { return answer().numbers.data(); }
__attribute__((export_name("studio_numbers_size"))) std::size_t studio_numbers_size() {
  return answer().numbers.size();
}
}
