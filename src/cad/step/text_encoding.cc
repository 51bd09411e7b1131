#include "cad/step/text_encoding.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <optional>

#include "base/utf8.h"
#include "cad/encoding.h"

namespace hvas::cad {
namespace {

constexpr char32_t kReplacement = 0xFFFD;

bool StartsWith(std::string_view text, std::string_view start) {
  return text.substr(0, start.size()) == start;
}

void AppendUtf8(char32_t c, std::string* out) {
  const auto put = [out](char32_t byte) { out->push_back(static_cast<char>(byte)); };
  if (c < 0x80) {
    put(c);
  } else if (c < 0x800) {
    put(0xC0 | (c >> 6));
    put(0x80 | (c & 0x3F));
  } else if (c < 0x10000) {
    put(0xE0 | (c >> 12));
    put(0x80 | ((c >> 6) & 0x3F));
    put(0x80 | (c & 0x3F));
  } else {
    put(0xF0 | (c >> 18));
    put(0x80 | ((c >> 12) & 0x3F));
    put(0x80 | ((c >> 6) & 0x3F));
    put(0x80 | (c & 0x3F));
  }
}

std::string Utf16ToUtf8(std::u16string_view units) {
  std::string text;
  for (std::size_t i = 0; i < units.size(); ++i) {
    const char32_t unit = units[i];
    const bool is_high = unit >= 0xD800 && unit < 0xDC00;
    const bool is_low = unit >= 0xDC00 && unit < 0xE000;
    if (is_high && i + 1 < units.size() && units[i + 1] >= 0xDC00 && units[i + 1] < 0xE000) {
      AppendUtf8(0x10000 + ((unit - 0xD800) << 10) + (units[++i] - 0xDC00U), &text);
    } else {
      AppendUtf8(is_high || is_low || unit >= 0xFFFE ? kReplacement : unit, &text);
    }
  }
  return text;
}

std::uint8_t ByteAt(std::string_view bytes, std::size_t i) {
  return static_cast<std::uint8_t>(bytes[i]);
}

/** Shift-JIS that no text in a Latin alphabet would be taken for. */
bool IsShiftJis(std::string_view bytes) {
  bool is_japanese = false;
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    const std::uint8_t lead = ByteAt(bytes, i);
    if (lead < 0x80 || (lead >= 0xA1 && lead <= 0xDF)) {  // ASCII, half-width katakana.
      continue;
    }
    const std::uint8_t trail = i + 1 < bytes.size() ? ByteAt(bytes, i + 1) : 0;
    const bool is_lead = (lead >= 0x81 && lead <= 0x9F) || (lead >= 0xE0 && lead <= 0xEF);
    if (!is_lead || trail < 0x40 || trail == 0x7F || trail > 0xFC) {
      return false;
    }
    is_japanese = is_japanese || lead <= 0x9F;
    ++i;
  }
  return is_japanese;
}

bool IsAsciiLetter(char c) {
  return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z');
}

bool IsLowerLetter(char c) {
  return c >= 'a' && c <= 'z';
}

/** Whether the byte at `i`, which is beyond ASCII, is an accented letter of code page 850 amidst
 letters (e with an acute accent may end a word) where Windows-1252 has neither a letter nor an
 apostrophe or dash. */
bool IsDosLetter(std::string_view bytes, std::size_t i) {
  constexpr std::string_view kSmall = "\x81\x82\x83\x84\x85\x86\x87\x88\x89\x8B\x8D\x93\x94";
  constexpr std::string_view kCapital = "\x80\x8F\x90";
  constexpr char kSmallAcuteE = '\x82';
  const char before = i > 0 ? bytes[i - 1] : ' ';
  const char after = i + 1 < bytes.size() ? bytes[i + 1] : ' ';
  const bool is_amidst =
      IsAsciiLetter(before) && (bytes[i] == kSmallAcuteE || IsAsciiLetter(after));
  // Small letters stand beside small ones; behind a lead byte of Shift-JIS stands anything.
  const bool is_small = kSmall.find(bytes[i]) != std::string_view::npos &&
                        (IsLowerLetter(before) || IsLowerLetter(after));
  return is_amidst && (is_small || kCapital.find(bytes[i]) != std::string_view::npos);
}

/** Latin text of DOS: every byte beyond ASCII is a letter of it, and no word has more than one of
 them to two others, which tells them from the lead bytes of Shift-JIS. */
bool IsDosLatin(std::string_view bytes) {
  std::size_t letters = 0;  // Of a word.
  std::size_t accented = 0;
  bool has_accents = false;
  for (std::size_t i = 0; i <= bytes.size(); ++i) {
    const bool is_beyond = i < bytes.size() && ByteAt(bytes, i) >= 0x80;
    if (is_beyond && !IsDosLetter(bytes, i)) {
      return false;
    }
    if (is_beyond) {
      ++accented;
    } else if (i < bytes.size() && IsAsciiLetter(bytes[i])) {
      ++letters;
    } else if (letters < 2 * accented) {
      return false;
    } else {
      has_accents = has_accents || accented > 0;
      letters = 0;
      accented = 0;
    }
  }
  return has_accents;
}

/** What the runs of bytes beyond ASCII in a text look like. */
struct Runs {
  std::size_t longest{0};         // [bytes]
  std::size_t bytes{0};           // Of all runs.
  std::size_t cyrillic_bytes{0};  // Of these: letters of Windows-1251.
  std::size_t pairs{0};           // That are characters of GB 2312, ...
  std::size_t common_pairs{0};    // ... and of its first level: the common Chinese characters.
  bool is_paired{true};           // Every run is a sequence of characters of GB 2312.
};

void AddRun(std::string_view run, Runs* runs) {
  runs->longest = std::max(runs->longest, run.size());
  runs->bytes += run.size();
  for (std::size_t i = 0; i < run.size(); ++i) {
    const std::uint8_t byte = ByteAt(run, i);
    constexpr std::uint8_t kIo = 0xA8;       // The letter that stands apart, as a capital ...
    constexpr std::uint8_t kSmallIo = 0xB8;  // ... and small.
    runs->cyrillic_bytes += byte >= 0xC0 || byte == kIo || byte == kSmallIo ? 1U : 0U;
  }
  runs->is_paired = runs->is_paired && run.size() % 2 == 0;
  for (std::size_t i = 0; i + 1 < run.size(); i += 2) {
    const std::uint8_t lead = ByteAt(run, i);
    const std::uint8_t trail = ByteAt(run, i + 1);
    const bool is_pair = ((lead >= 0xA1 && lead <= 0xA9) || (lead >= 0xB0 && lead <= 0xF7)) &&
                         trail >= 0xA1 && trail <= 0xFE;
    runs->is_paired = runs->is_paired && is_pair;
    runs->pairs += is_pair ? 1U : 0U;
    runs->common_pairs += is_pair && lead >= 0xB0 && lead <= 0xD7 ? 1U : 0U;
  }
}

Runs FindRuns(std::string_view bytes) {
  Runs runs;
  for (std::size_t i = 0; i < bytes.size();) {
    std::size_t end = i;
    while (end < bytes.size() && ByteAt(bytes, end) >= 0x80) {
      ++end;
    }
    if (end > i) {
      AddRun(bytes.substr(i, end - i), &runs);
    }
    i = end + 1;
  }
  return runs;
}

/** Chinese text: two characters stand together somewhere, which no Latin alphabet would write with
 four letters beyond ASCII, and most are common ones. Where all bytes are letters of Windows-1251,
 too, it is Russian: a Chinese character has such bytes in two of three cases. */
bool IsChinese(const Runs& runs) {
  return runs.is_paired && runs.longest >= 4 && 4 * runs.common_pairs >= 3 * runs.pairs &&
         runs.cyrillic_bytes < runs.bytes;
}

/** Text of another alphabet: three letters beyond ASCII in a row, which languages with the Latin
 alphabet do not have. */
bool IsCyrillic(const Runs& runs) {
  return runs.longest >= 3 && 10 * runs.cyrillic_bytes >= 9 * runs.bytes;
}

/** Without control characters (they become blanks) and surrounding blanks. */
std::string Tidy(std::string text) {
  std::replace_if(
      text.begin(), text.end(),
      [](char c) { return static_cast<std::uint8_t>(c) < 0x20 || c == 0x7F; }, ' ');
  const std::size_t first = text.find_first_not_of(' ');
  return first == std::string::npos ? std::string()
                                    : text.substr(first, text.find_last_not_of(' ') - first + 1);
}

/** Takes `digits` hexadecimal digits from the front of a text. */
std::optional<char32_t> TakeHex(std::string_view* text, std::size_t digits) {
  std::uint32_t value = 0;
  const char* begin = text->data();
  if (text->size() < digits) {
    return std::nullopt;
  }
  const auto parsed = std::from_chars(begin, begin + digits, value, 16);
  if (parsed.ec != std::errc() || parsed.ptr != begin + digits) {
    return std::nullopt;
  }
  text->remove_prefix(digits);
  return value;
}

/** Takes the code units behind "\X2\" or "\X4\" up to "\X0\". @returns false where they do not
 end so. */
bool TakeCodeUnits(std::string_view* text, std::size_t digits, std::string* out) {
  std::u16string units;
  while (const auto unit = TakeHex(text, digits)) {
    if (*unit < 0x10000) {
      units.push_back(static_cast<char16_t>(*unit));
    } else {  // A pair of surrogates.
      units.push_back(static_cast<char16_t>(0xD800 + (((*unit - 0x10000) >> 10) & 0x3FF)));
      units.push_back(static_cast<char16_t>(0xDC00 + ((*unit - 0x10000) & 0x3FF)));
    }
  }
  *out += Utf16ToUtf8(units);
  if (!StartsWith(*text, "\\X0\\")) {
    return false;
  }
  text->remove_prefix(4);
  return true;
}

/** Takes one escape from the front of a text.
 @param page  The part of ISO 8859 that "\S\" refers to, from "\PA\" on: "1" to "9".
 @returns false where there is none. */
bool TakeEscape(std::string_view* text, char* page, std::string* out) {
  std::string_view rest = *text;
  std::string decoded;
  bool is_escape = false;
  if (StartsWith(rest, "\\X2\\") || StartsWith(rest, "\\X4\\")) {
    const std::size_t digits = rest[2] == '2' ? 4 : 8;
    rest.remove_prefix(4);
    is_escape = TakeCodeUnits(&rest, digits, &decoded);
  } else if (StartsWith(rest, "\\X\\")) {
    rest.remove_prefix(3);
    if (const auto byte = TakeHex(&rest, 2)) {
      AppendUtf8(*byte, &decoded);
      is_escape = true;
    }
  } else if (StartsWith(rest, "\\S\\") && rest.size() > 3 && ByteAt(rest, 3) < 0x80) {
    const char byte = static_cast<char>(ByteAt(rest, 3) + 0x80U);
    decoded = ToUtf8({&byte, 1}, std::string("ISO-8859-") + *page);
    rest.remove_prefix(4);
    is_escape = true;
  } else if (StartsWith(rest, "\\P") && rest.size() > 3 && rest[2] >= 'A' && rest[2] <= 'I' &&
             rest[3] == '\\') {
    *page = static_cast<char>('1' + (rest[2] - 'A'));
    rest.remove_prefix(4);
    is_escape = true;
  } else if (StartsWith(rest, "\\\\")) {
    decoded = "\\";
    rest.remove_prefix(2);
    is_escape = true;
  }
  if (is_escape) {
    *out += decoded;
    *text = rest;
  }
  return is_escape;
}

/** Whether UTF-8 has a control character of ISO 8859-1 (U+0080 to U+009F): no name has one, but raw
 bytes of a code page become them where they are taken for ISO 8859-1. */
bool HasControlsBeyondAscii(std::string_view utf8) {
  for (std::size_t i = 0; i + 1 < utf8.size(); ++i) {
    if (ByteAt(utf8, i) == 0xC2 && ByteAt(utf8, i + 1) < 0xA0) {
      return true;
    }
  }
  return false;
}

/** UTF-8 as ISO 8859-1; empty where a character is not in it. */
std::string NarrowUtf8(std::string_view utf8) {
  std::string bytes;
  for (std::size_t i = 0; i < utf8.size(); ++i) {
    const std::uint8_t byte = ByteAt(utf8, i);
    if (byte < 0x80) {
      bytes.push_back(static_cast<char>(byte));
    } else if (byte <= 0xC3 && i + 1 < utf8.size()) {
      bytes.push_back(static_cast<char>(((byte & 0x03U) << 6U) | (ByteAt(utf8, ++i) & 0x3FU)));
    } else {
      return {};
    }
  }
  return bytes;
}

/** UTF-8 from the bytes of one name that nobody decoded. */
std::string DecodeRaw(std::string_view bytes) {
  return Tidy(ToUtf8(bytes, IsDosLatin(bytes) ? "CP850" : IsShiftJis(bytes) ? "CP932" : "CP1252"));
}

}  // namespace

std::string DecodeStepText(std::string_view text) {
  std::string decoded;
  char page = '1';
  while (!text.empty()) {
    if (text.front() == '\\' && TakeEscape(&text, &page, &decoded)) {
      continue;
    }
    decoded.push_back(text.front());
    text.remove_prefix(1);
  }
  return decoded;
}

bool IsUtf8(std::string_view bytes) {
  for (std::size_t i = 0; i < bytes.size();) {
    // By definition: ASCII has seven bits, so that the eighth bit of its bytes is not set.
    constexpr std::uint64_t kBeyondAscii = 0x8080808080808080;
    std::uint64_t eight = kBeyondAscii;
    if (i + sizeof(eight) <= bytes.size()) {
      std::memcpy(&eight, bytes.data() + i, sizeof(eight));
    }
    if ((eight & kBeyondAscii) == 0) {
      i += sizeof(eight);
      continue;
    }
    const std::size_t length = MeasureUtf8(bytes, i);
    if (length == 0) {
      return false;
    }
    i += length;
  }
  return true;
}

std::string GuessEncoding(std::string_view bytes) {
  if (IsUtf8(bytes)) {
    return "UTF-8";
  }
  if (IsDosLatin(bytes)) {
    return "CP850";
  }
  if (IsShiftJis(bytes)) {
    return "CP932";
  }
  const Runs runs = FindRuns(bytes);
  return IsChinese(runs) ? "GB18030" : IsCyrillic(runs) ? "CP1251" : "CP1252";
}

std::string CleanName(std::string_view name) {
  if (!IsUtf8(name)) {
    return Tidy(ToUtf8(name, GuessEncoding(name)));
  }
  const std::string raw = HasControlsBeyondAscii(name) ? NarrowUtf8(name) : std::string();
  return raw.empty() ? Tidy(std::string(name)) : DecodeRaw(raw);
}

std::string CleanName(std::u16string_view name) {
  const bool is_narrow =
      std::all_of(name.begin(), name.end(), [](char16_t unit) { return unit <= 0xFF; });
  if (!is_narrow) {
    return Tidy(Utf16ToUtf8(name));
  }
  std::string bytes;
  for (const char16_t unit : name) {
    bytes.push_back(static_cast<char>(unit));
  }
  return IsUtf8(bytes) ? Tidy(bytes) : DecodeRaw(bytes);
}

}  // namespace hvas::cad
