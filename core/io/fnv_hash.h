// The 64-bit hash of Fowler, Noll and Vo (FNV-1a): tells whether two runs have the same bits. No protection
// against anybody who wants to deceive.
#pragma once

#include <bit>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace cloth {

class FnvHash {
 public:
  void add(std::string_view bytes) {
    for (const char byte : bytes) add_byte(static_cast<unsigned char>(byte));
  }
  void add(std::uint64_t number) {
    for (int byte = 0; byte < 8; ++byte) add_byte(static_cast<unsigned char>(number >> (8 * byte)));
  }
  void add(std::span<const double> numbers) {
    for (const double number : numbers) add(std::bit_cast<std::uint64_t>(number));
  }

  /// 16 hexadecimal digits.
  std::string text() const {
    std::string digits(16, '0');
    for (int n = 0; n < 16; ++n) digits[n] = "0123456789abcdef"[(hash_ >> (60 - 4 * n)) & 15];
    return digits;
  }

 private:
  void add_byte(unsigned char byte) { hash_ = (hash_ ^ byte) * 1099511628211u; }

  std::uint64_t hash_ = 14695981039346656037u;
};

}  // namespace cloth
