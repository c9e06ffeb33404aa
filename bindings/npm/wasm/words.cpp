// Formats error sentences without the C library's printf, which would add over 3 kB to the download. It supports %s,
// %u, %zu, %016llx, and the %f of std::to_string(); any other conversion writes nothing and takes no argument.

#include <cmath>
#include <cstdarg>
#include <cstddef>
#include <cstdint>

namespace {

class Words {
 public:
  Words(char* out, std::size_t room) : out_(out), room_(room) {}

  void add(char letter) {
    if (size_ + 1 < room_) out_[size_] = letter;
    ++size_;
  }
  void add(const char* letters) {
    while (*letters) add(*letters++);
  }
  void add(std::uint64_t number, unsigned base, int min_digits) {
    char digits[20];
    int count = 0;
    for (; number > 0 || count < min_digits; number /= base) {
      digits[count++] = "0123456789abcdef"[number % base];
    }
    while (count > 0) add(digits[--count]);
  }
  // Writes six decimals. From 1e18 on, digits after the first eighteen are written as zeros.
  void add(double number) {
    if (std::isnan(number)) return add("nan");
    if (std::signbit(number)) add('-');
    number = std::abs(number);
    if (std::isinf(number)) return add("inf");
    int zeros = 0;
    for (; number >= 1e18; number /= 10) ++zeros;
    auto whole = static_cast<std::uint64_t>(number);
    auto millionths = static_cast<std::uint64_t>((number - static_cast<double>(whole)) * 1e6 + 0.5);
    if (millionths == 1'000'000) {
      millionths = 0;
      ++whole;
    }
    add(whole, 10, 1);
    while (zeros-- > 0) add('0');
    add('.');
    add(millionths, 10, 6);
  }

  int end() {
    if (room_ > 0) out_[size_ < room_ ? size_ : room_ - 1] = '\0';
    return static_cast<int>(size_);
  }

 private:
  char* out_;
  std::size_t room_;
  std::size_t size_ = 0;
};

}  // namespace

extern "C" int vsnprintf(char* out, std::size_t room, const char* format, std::va_list values) {
  Words words(out, room);
  for (; *format; ++format) {
    if (*format != '%') {
      words.add(*format);
      continue;
    }
    while (*++format == 'z' || *format == 'l' || *format == '0' || *format == '1' || *format == '6') continue;
    if (*format == 's') words.add(va_arg(values, const char*));
    if (*format == 'u') words.add(std::uint64_t{va_arg(values, unsigned)}, 10, 1);  // size_t is no larger here
    if (*format == 'x') words.add(va_arg(values, unsigned long long), 16, 16);
    if (*format == 'f') words.add(va_arg(values, double));
  }
  return words.end();
}
