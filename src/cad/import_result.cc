#include "cad/import_result.h"

#include <array>
#include <utility>

#include "base/bytes.h"
#include "base/digest.h"
#include "product/product_io.h"

namespace hvas::cad {
namespace {

constexpr std::array<char, 8> kMagic{'H', 'V', 'A', 'S', 'R', 'E', 'A', 'D'};

struct Header {
  std::array<char, 8> magic{kMagic};
  std::uint32_t format{product::kProductFormat};
  std::uint32_t header_size{0};
  std::uint64_t size{0};  // Of the bytes that follow.
  std::uint64_t checksum{0};
};

static_assert(sizeof(Header) == 32);

Header HeaderOf(std::span<const std::byte> bytes) {
  Header header;
  header.header_size = sizeof(Header);
  header.size = bytes.size();
  header.checksum = Checksum64(bytes);
  return header;
}

/** What stands behind a header that fits; none where it does not. */
std::optional<std::span<const std::byte>> CheckHeader(std::span<const std::byte> bytes) {
  if (bytes.size() < sizeof(Header)) {
    return std::nullopt;
  }
  const auto rest = bytes.subspan(sizeof(Header));
  const Header expected = HeaderOf(rest);
  if (std::memcmp(bytes.data(), &expected, sizeof(Header)) != 0) {
    return std::nullopt;
  }
  return rest;
}

std::vector<ReferredFile> ReadFiles(ByteReader* reader) {
  std::vector<ReferredFile> files(reader->Size(2 * sizeof(std::uint64_t)));
  for (ReferredFile& file : files) {
    reader->Text(&file.path);
    reader->Text(&file.digest);
  }
  return files;
}

Error ReadError(ByteReader* reader) {
  Error error;
  std::uint8_t code = 0;
  reader->Plain(&code, 1);
  if (code > static_cast<std::uint8_t>(ErrorCode::kInternal)) {
    reader->Fail();
  } else {
    error.code = static_cast<ErrorCode>(code);
  }
  reader->Text(&error.message);
  reader->Text(&error.where);
  reader->Text(&error.remedy);
  return error;
}

}  // namespace

std::vector<std::byte> Serialise(const ImportResult& result) {
  ByteWriter writer;
  const Header room;
  writer.Plain(&room, 1);
  writer.Size(result.referred_files.size());
  for (const ReferredFile& file : result.referred_files) {
    writer.Text(file.path);
    writer.Text(file.digest);
  }
  product::WriteDiagnostics(result.diagnostics, &writer);
  const std::uint8_t is_product = result.product ? 1 : 0;
  writer.Plain(&is_product, 1);
  if (result.product) {
    product::WriteProduct(*result.product, &writer);
  } else {
    const Error& error = result.product.error();
    const auto code = static_cast<std::uint8_t>(error.code);
    writer.Plain(&code, 1);
    writer.Text(error.message);
    writer.Text(error.where);
    writer.Text(error.remedy);
  }
  std::vector<std::byte>& bytes = writer.bytes();
  const Header header = HeaderOf(std::span(bytes).subspan(sizeof(Header)));
  std::memcpy(bytes.data(), &header, sizeof(Header));
  return std::move(bytes);
}

std::optional<ImportResult> DeserialiseImportResult(std::span<const std::byte> bytes) {
  const auto rest = CheckHeader(bytes);
  if (!rest) {
    return std::nullopt;
  }
  ByteReader reader(*rest);
  ImportResult result;
  result.referred_files = ReadFiles(&reader);
  result.diagnostics = product::ReadDiagnostics(&reader);
  std::uint8_t is_product = 0;
  reader.Plain(&is_product, 1);
  if (is_product != 0) {
    result.product = product::ReadProduct(&reader);
  } else {
    result.product = Unexpected(ReadError(&reader));
  }
  return reader.is_finished() ? std::optional(std::move(result)) : std::nullopt;
}

std::optional<std::vector<ReferredFile>> DeserialiseReferredFiles(
    std::span<const std::byte> bytes) {
  if (bytes.size() < sizeof(Header)) {
    return std::nullopt;
  }
  ByteReader reader(bytes.subspan(sizeof(Header)));
  auto files = ReadFiles(&reader);
  return reader.has_failed() ? std::nullopt : std::optional(std::move(files));
}

}  // namespace hvas::cad
