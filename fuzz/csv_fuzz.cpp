// Reads any text as a recording, in Wisp's format or as a foreign table: what is accepted is valid, and reads the same
// after it is written.

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <sstream>
#include <string>

#include "wisp/record/csv.hpp"

namespace {

void expect_written_back(const wisp::Recording& recording) {
  if (!wisp::check(recording)) std::abort();
  // Foreign tables may have names that Wisp's own format cannot write.
  for (const wisp::Channel& channel : recording.channels) {
    if ((channel.name + channel.unit).find_first_of("[]\n\r") != std::string::npos) return;
  }
  std::istringstream again(wisp::csv_text(recording));
  const auto copy = wisp::read_csv(again, "again");
  if (!copy || copy->rows() != recording.rows()) std::abort();
  for (std::size_t k = 0; k < recording.channels.size(); ++k) {
    for (std::size_t row = 0; row < recording.rows(); ++row) {
      const double was = recording.channels[k].samples[row], is = copy->channels[k].samples[row];
      if (was != is && !(std::isnan(was) && std::isnan(is))) std::abort();
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  for (const wisp::CsvOptions& options :
       {wisp::CsvOptions{}, wisp::CsvOptions{.rate_hz = 2, .inputs = {"u"}, .outputs = {"y"}},
        wisp::CsvOptions{.rate_hz = 2, .inputs = {"u"}, .outputs = {"y"}, .columns = {"u", "y"}}}) {
    std::istringstream stream(text);
    const auto recording = wisp::read_csv(stream, "fuzz", options);
    if (recording) expect_written_back(*recording);
  }
  return 0;
}
