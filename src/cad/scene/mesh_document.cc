#include "cad/scene/mesh_document.h"

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include <assimp/Importer.hpp>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include "base/units.h"
#include "cad/input_file.h"
#include "cad/scene/confined_io.h"
#include "cad/scene/gltf_nodes.h"
#include "cad/scene/mesh_scene.h"
#include "cad/scene/model_3mf.h"
#include "cad/scene/placed_parts.h"
#include "cad/scene/zip_entry.h"

namespace hvas::cad {
namespace {

using product::Product;

constexpr std::uint64_t kUnpackedShare = 2;  // XML takes several times its size while it is read.

/** Unit and names of a 3MF file, which assimp passes over. Errors: kUnsupported (too large when it
 is unpacked, or too many parts), kUnreadable (no model that can be read: assimp ends the process
 then). */
Result<void> Read3mfModel(const std::filesystem::path& file, const ImportOptions& options,
                          SceneConventions* conventions, Diagnostics* diagnostics) {
  const std::string name = file.filename().string();
  const std::uint64_t most = options.max_bytes / kUnpackedShare;
  const auto archive = MappedFile::Open(file);
  if (const std::uint64_t unpacked = archive ? SumUnpackedSizes(archive->bytes()) : 0;
      unpacked > most) {
    return FailTooManyBytes("the unpacked file takes", static_cast<double>(unpacked), most, name);
  }
  const auto is_model = [](std::string_view entry) {
    std::string lower(entry);
    std::transform(lower.begin(), lower.end(), lower.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return lower.rfind("3d/", 0) == 0 && lower.find('/', 3) == std::string::npos &&
           lower.size() > 6 && lower.compare(lower.size() - 6, 6, ".model") == 0;
  };
  const auto xml =
      archive ? ReadZipEntry(archive->bytes(), is_model, most) : std::optional<std::string>();
  if (!xml) {
    return Fail(ErrorCode::kUnreadable,
                "the 3MF file could not be read: the archive is damaged, or holds no model", name,
                "export the file again");
  }
  const Model3mf model = ParseModel3mf(*xml);
  if (auto checked = CheckTree(model.placed, options.max_parts, name, "object"); !checked) {
    return checked;
  }
  conventions->length_unit = model.length_unit;
  if (!model.is_unit_known && !options.length_unit) {
    diagnostics->Warn("assumed-unit", name,
                      "the file names a unit that 3MF does not have; millimetres are assumed",
                      "export the file again in millimetres");
  }
  for (const auto& [id, given] : model.names) {
    conventions->names.emplace(fmt::format("Object_{}", id), given);
  }
  return {};
}

/** An error for a file that is too damaged, or places too much, to be shown to assimp. */
Result<SceneConventions> FindConventions(const std::filesystem::path& file, MeshFormat format,
                                         const ImportOptions& options, Diagnostics* diagnostics) {
  SceneConventions conventions;
  conventions.format = format;
  Result<void> checked;
  switch (format) {
    case MeshFormat::kGltf:
      conventions.is_y_up = true;
      if (const auto bytes = MappedFile::Open(file)) {
        checked = CheckTree(ExamineGltfNodes(bytes->bytes()), options.max_parts,
                            file.filename().string(), "node");
      }
      break;
    case MeshFormat::k3mf:
      checked = Read3mfModel(file, options, &conventions, diagnostics);
      break;
    case MeshFormat::kStl:
    case MeshFormat::kObj:
      conventions.length_unit = units::kMetresPerMillimetre;
      if (!options.length_unit) {
        diagnostics->Note(
            "assumed-unit", file.filename().string(),
            fmt::format("{} files have no unit; millimetres are assumed", NameOf(format)),
            "give the unit: --unit mm, cm, m, in or ft");
      }
      break;
  }
  conventions.length_unit = options.length_unit.value_or(conventions.length_unit);
  return checked ? Result<SceneConventions>(std::move(conventions)) : Unexpected(checked.error());
}

void ReportFiles(const ConfinedIo::Log& log, const std::filesystem::path& file,
                 const ReadWatch& watch, Diagnostics* diagnostics) {
  std::vector<std::filesystem::path> missing = log.missing;
  std::sort(missing.begin(), missing.end());
  missing.erase(std::unique(missing.begin(), missing.end()), missing.end());
  for (const std::filesystem::path& path : missing) {
    diagnostics->Warn(
        "missing-file", path.filename().string(),
        fmt::format("{} refers to this file, which does not exist", file.filename().string()),
        "put the missing file beside the file");
  }
  for (const std::string& name : log.refused) {
    diagnostics->Warn("refused-file", name,
                      fmt::format("{} refers to this file outside its own folder; it was not read",
                                  file.filename().string()),
                      "put the file into the folder and refer to it by its name");
  }
  if (watch.referred_files != nullptr) {
    std::vector<std::filesystem::path>& referred = *watch.referred_files;
    referred = log.read;
    referred.insert(referred.end(), missing.begin(), missing.end());
    std::sort(referred.begin(), referred.end());
    referred.erase(std::unique(referred.begin(), referred.end()), referred.end());
    std::erase(referred, file);
  }
}

Unexpected FailToRead(const std::string& name, MeshFormat format, const char* why,
                      const ConfinedIo::Log& log) {
  if (!log.refused.empty()) {
    return Fail(ErrorCode::kUnreadable,
                fmt::format("the file needs {}, which is outside its folder", log.refused.front()),
                name, "put both files into one folder");
  }
  if (!log.missing.empty()) {
    return Fail(ErrorCode::kNotFound,
                fmt::format("the file needs {}, which does not exist",
                            log.missing.front().filename().string()),
                name, "put both files into one folder");
  }
  return Fail(ErrorCode::kUnreadable,
              fmt::format("the {} file could not be read: {}", NameOf(format), why), name,
              "export the file again");
}

}  // namespace

Result<Product> ReadMeshFile(const std::filesystem::path& file, MeshFormat format,
                             const ImportOptions& options, const ReadWatch& watch,
                             Diagnostics* diagnostics) {
  if (watch.progress) {
    watch.progress("read", 0);
  }
  const std::string name = file.filename().string();
  const Result<SceneConventions> conventions = FindConventions(file, format, options, diagnostics);
  if (!conventions) {
    return Unexpected(conventions.error());
  }
  ConfinedIo::Log log;
  Assimp::Importer importer;
  importer.SetIOHandler(new ConfinedIo(file, &log));  // The importer owns it.
  const aiScene* scene =
      importer.ReadFile(file.string(), aiProcess_ValidateDataStructure | aiProcess_Triangulate);
  if (scene == nullptr || scene->mRootNode == nullptr) {
    return FailToRead(name, format, importer.GetErrorString(), log);
  }
  Product product;
  product.name = file.stem().string();
  product.source = name;
  ReportFiles(log, file, watch, diagnostics);
  if (const auto built =
          BuildSceneProduct(*scene, *conventions, options, watch, &product, diagnostics);
      !built) {
    return Unexpected(built.error());
  }
  if (product.occurrences.empty()) {
    return Fail(ErrorCode::kUnreadable, "the file has no triangles", name,
                "export the surfaces of the parts as triangles");
  }
  return product;
}

}  // namespace hvas::cad
