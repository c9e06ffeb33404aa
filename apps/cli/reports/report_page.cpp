#include "reports/report_page.hpp"

#include <cstddef>
#include <cstdint>
#include <span>

#include "wisp/base/file.hpp"
#include "wisp/describe/text.hpp"

namespace wisp::cli {
namespace {

constexpr const char* kStyle = R"(
body { font: 15px/1.5 system-ui, sans-serif; color: #222; max-width: 60rem; margin: 2rem auto; padding: 0 1rem; }
h1, h2, h3 { line-height: 1.2; } h2 { margin-top: 3rem; border-top: 1px solid #ccc; padding-top: 1.5rem; }
.verdict { font-weight: 600; padding: .6rem 1rem; border-left: 4px solid; }
.usable { color: #22682d; background: #eef7ef; } .refused { color: #9a2a1c; background: #fbeeec; }
.warnings { color: #7a5200; }
table { border-collapse: collapse; margin: .8rem 0; display: block; overflow-x: auto; }
caption { text-align: left; color: #555; }
th, td { text-align: left; vertical-align: top; padding: .2rem .8rem .2rem 0; font-variant-numeric: tabular-nums; }
th { font-weight: 500; } .figures td:last-child { color: #666; }
img { max-width: 100%; display: block; margin: 1rem 0; }
)";

// RFC 4648, section 4.
std::string base64(std::span<const std::byte> bytes) {
  constexpr const char* kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (std::size_t k = 0; k < bytes.size(); k += 3) {
    std::uint32_t word = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      word = word << 8 | (k + i < bytes.size() ? std::to_integer<std::uint32_t>(bytes[k + i]) : 0U);
    }
    for (std::size_t i = 0; i < 4; ++i) {
      out += k + i > bytes.size() ? '=' : kDigits[word >> (18 - 6 * i) & 63];
    }
  }
  return out;
}

// Each picture is a document of its own, so that names within two of them do not meet.
Result<std::string> picture_of(const std::filesystem::path& path) {
  const auto bytes = read_file(path);
  if (!bytes) return bytes.error();
  const char* type = path.extension() == ".svg" ? "image/svg+xml" : "image/png";
  return "<img alt=\"" + html_escaped(path.stem().string()) + "\" src=\"data:" + type + ";base64," + base64(*bytes) +
         "\">\n";
}

}  // namespace

Result<std::string> report_page(const std::string& title, const std::vector<PagePart>& parts) {
  std::string out =
      "<!doctype html>\n<html lang=\"en\">\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width\">\n<title>" +
      html_escaped(title) + "</title>\n<style>" + kStyle + "</style>\n<h1>" + html_escaped(title) + "</h1>\n";
  for (const PagePart& part : parts) {
    out += "<h2>" + html_escaped(part.title) + "</h2>\n" + to_html(part.report);
    for (const std::filesystem::path& path : part.pictures) {
      const auto picture = picture_of(path);
      if (!picture) return picture.error();
      out += *picture;
    }
  }
  return out + "</html>\n";
}

}  // namespace wisp::cli
