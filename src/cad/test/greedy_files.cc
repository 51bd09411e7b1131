#include "cad/test/greedy_files.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <zlib.h>

namespace hvas::cad::testing {
namespace {

// Corners by the bits of their number; outward.
constexpr std::array<std::array<std::uint16_t, 3>, 12> kTriangles{{{0, 2, 3},
                                                                   {0, 3, 1},
                                                                   {4, 5, 7},
                                                                   {4, 7, 6},
                                                                   {0, 1, 5},
                                                                   {0, 5, 4},
                                                                   {2, 6, 7},
                                                                   {2, 7, 3},
                                                                   {0, 4, 6},
                                                                   {0, 6, 2},
                                                                   {1, 3, 7},
                                                                   {1, 7, 5}}};

template <typename T>
void AppendBytes(T value, std::string* bytes) {
  std::array<char, sizeof(T)> raw{};
  std::memcpy(raw.data(), &value, sizeof(T));
  bytes->append(raw.data(), raw.size());
}

/** Writes by pieces, so that a bomb is never in memory as a whole; `fill` bytes of 'x' follow the
 * data. */
std::pair<std::string, std::uint32_t> Deflate(const std::string& data, std::size_t fill) {
  z_stream stream{};
  if (deflateInit2(&stream, Z_BEST_COMPRESSION, Z_DEFLATED, -MAX_WBITS, 9, Z_DEFAULT_STRATEGY) !=
      Z_OK) {
    throw std::runtime_error("zlib");
  }
  std::string packed;
  uLong crc = crc32(0, nullptr, 0);
  std::vector<char> out(1 << 16);
  const auto feed = [&](const char* bytes, std::size_t size, int flush) {
    crc = crc32(crc, reinterpret_cast<const Bytef*>(bytes), static_cast<uInt>(size));
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes));
    stream.avail_in = static_cast<uInt>(size);
    do {
      stream.next_out = reinterpret_cast<Bytef*>(out.data());
      stream.avail_out = static_cast<uInt>(out.size());
      deflate(&stream, flush);
      packed.append(out.data(), out.size() - stream.avail_out);
    } while (stream.avail_out == 0);
  };
  feed(data.data(), data.size(), Z_NO_FLUSH);
  const std::vector<char> piece(1 << 20, 'x');
  for (std::size_t rest = fill; rest > 0;) {
    const std::size_t size = std::min(rest, piece.size());
    feed(piece.data(), size, Z_NO_FLUSH);
    rest -= size;
  }
  feed("", 0, Z_FINISH);
  deflateEnd(&stream);
  return {packed, static_cast<std::uint32_t>(crc)};
}

struct Entry {
  std::string name;
  std::string data;
  std::size_t fill{0};
};

std::string Zip(const std::vector<Entry>& entries) {
  std::string bytes;
  std::string directory;
  for (const Entry& entry : entries) {
    const auto offset = static_cast<std::uint32_t>(bytes.size());
    const auto [packed, crc] = Deflate(entry.data, entry.fill);
    std::string common;
    AppendBytes(std::uint16_t{20}, &common);
    AppendBytes(std::uint16_t{0}, &common);
    AppendBytes(std::uint16_t{8}, &common);  // Deflated.
    common.append(4, '\0');                  // Time, date.
    AppendBytes(crc, &common);
    AppendBytes(static_cast<std::uint32_t>(packed.size()), &common);
    AppendBytes(static_cast<std::uint32_t>(entry.data.size() + entry.fill), &common);
    AppendBytes(static_cast<std::uint16_t>(entry.name.size()), &common);
    AppendBytes(std::uint16_t{0}, &common);
    bytes += std::string("PK\x03\x04", 4) + common + entry.name + packed;
    directory += std::string("PK\x01\x02", 4) + std::string("\x14\0", 2) + common;
    directory.append(10, '\0');
    AppendBytes(offset, &directory);
    directory += entry.name;
  }
  const auto start = static_cast<std::uint32_t>(bytes.size());
  bytes += directory + std::string("PK\x05\x06\0\0\0\0", 8);
  AppendBytes(static_cast<std::uint16_t>(entries.size()), &bytes);
  AppendBytes(static_cast<std::uint16_t>(entries.size()), &bytes);
  AppendBytes(static_cast<std::uint32_t>(directory.size()), &bytes);
  AppendBytes(start, &bytes);
  bytes.append(2, '\0');
  return bytes;
}

std::string Model(const std::string& objects, const std::string& build) {
  std::string model =
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<model unit=\"millimeter\" "
      "xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\"><resources>"
      "<object id=\"1\" name=\"box\" type=\"model\"><mesh><vertices>";
  for (int i = 0; i < 8; ++i) {
    model += fmt::format("<vertex x=\"{}\" y=\"{}\" z=\"{}\"/>", (i & 1) * 10, (i >> 1 & 1) * 10,
                         (i >> 2 & 1) * 10);
  }
  model += "</vertices><triangles>";
  for (const auto& t : kTriangles) {
    model += fmt::format("<triangle v1=\"{}\" v2=\"{}\" v3=\"{}\"/>", t[0], t[1], t[2]);
  }
  return model + "</triangles></mesh></object>" + objects + "</resources><build>" + build +
         "</build></model>";
}

std::vector<Entry> Package(const std::string& model, std::size_t fill = 0) {
  return {{"[Content_Types].xml",
           "<?xml version=\"1.0\" encoding=\"UTF-8\"?><Types "
           "xmlns=\"http://schemas.openxmlformats.org/package/2006/content-types\"><Default "
           "Extension=\"rels\" "
           "ContentType=\"application/vnd.openxmlformats-package.relationships+xml\"/><Default "
           "Extension=\"model\" "
           "ContentType=\"application/vnd.ms-package.3dmanufacturing-3dmodel+xml\"/></Types>"},
          {"_rels/.rels",
           "<?xml version=\"1.0\" encoding=\"UTF-8\"?><Relationships "
           "xmlns=\"http://schemas.openxmlformats.org/package/2006/relationships\"><Relationship "
           "Target=\"/3D/3dmodel.model\" Id=\"rel0\" "
           "Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\"/>"
           "</Relationships>"},
          {"3D/3dmodel.model", model, fill}};
}

std::string Repeat(const std::string& text, std::size_t count) {
  std::string all;
  all.reserve(text.size() * count);
  for (std::size_t i = 0; i < count; ++i) {
    all += text;
  }
  return all;
}

std::string Base64(const std::string& bytes) {
  constexpr const char* kLetters =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i + 2 < bytes.size(); i += 3) {  // The size is a multiple of 3.
    unsigned value = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      value = value << 8U | static_cast<unsigned char>(bytes[i + k]);
    }
    for (int shift = 18; shift >= 0; shift -= 6) {
      text.push_back(kLetters[value >> static_cast<unsigned>(shift) & 63U]);
    }
  }
  return text;
}

std::string Gltf(const std::string& roots, const std::string& nodes) {
  std::string buffer;
  for (int i = 0; i < 8; ++i) {
    for (int k = 0; k < 3; ++k) {
      AppendBytes((i >> k & 1) != 0 ? 0.01F : 0.0F, &buffer);
    }
  }
  for (const auto& t : kTriangles) {
    for (const std::uint16_t v : t) {
      AppendBytes(v, &buffer);
    }
  }
  return fmt::format(
      R"({{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[{}]}}],"nodes":[{}],)"
      R"("meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},"indices":1}}]}}],)"
      R"("accessors":[{{"bufferView":0,"componentType":5126,"count":8,"type":"VEC3",)"
      R"("min":[0,0,0],"max":[0.01,0.01,0.01]}},)"
      R"({{"bufferView":1,"componentType":5123,"count":36,"type":"SCALAR"}}],)"
      R"("bufferViews":[{{"buffer":0,"byteLength":96}},)"
      R"({{"buffer":0,"byteOffset":96,"byteLength":72}}],)"
      R"("buffers":[{{"byteLength":168,"uri":"data:application/octet-stream;base64,{}"}}]}})",
      roots, nodes, Base64(buffer));
}

std::string NumbersBelow(std::size_t count) {
  std::string text;
  for (std::size_t i = 0; i < count; ++i) {
    text += (i > 0 ? "," : "") + std::to_string(i);
  }
  return text;
}

/** The number of the first entity of a type, and what it says. */
std::pair<std::string, std::string> FindEntity(const std::string& step, const std::string& type) {
  for (std::size_t at = step.find(type); at != std::string::npos; at = step.find(type, at + 1)) {
    const std::size_t open = at + type.size();
    const std::size_t number = step.rfind('#', at);
    const std::size_t equals = step.find('=', number);
    const bool is_it =
        step[open] == '(' && equals < at && step.find_first_not_of(" =", equals) == at;
    if (is_it) {
      std::string id = step.substr(number, equals - number);
      id.erase(id.find_last_not_of(' ') + 1);
      return {id, step.substr(open, step.find(';', open) - open)};
    }
  }
  throw std::runtime_error("no " + type);
}

/** The references in the text of an entity, in its order. */
std::vector<std::string> References(const std::string& text) {
  std::vector<std::string> found;
  for (std::size_t at = text.find('#'); at != std::string::npos; at = text.find('#', at + 1)) {
    found.push_back(text.substr(at, text.find_first_not_of("0123456789", at + 1) - at));
  }
  return found;
}

}  // namespace

std::string MakeManyItems3mf(std::size_t count) {
  return Zip(Package(Model("", Repeat("<item objectid=\"1\"/>", count))));
}

std::string MakeDoubling3mf(std::size_t levels) {
  std::string objects;
  for (std::size_t i = 1; i <= levels; ++i) {
    objects += fmt::format(
        "<object id=\"{}\" type=\"model\"><components><component objectid=\"{}\"/>"
        "<component objectid=\"{}\"/></components></object>",
        i + 1, i, i);
  }
  return Zip(Package(Model(objects, fmt::format("<item objectid=\"{}\"/>", levels + 1))));
}

std::string MakeCircle3mf(bool is_built) {
  std::string objects;
  for (const auto& [id, used] : {std::pair(2, 3), std::pair(3, 2)}) {
    objects += fmt::format(
        "<object id=\"{}\"><components><component objectid=\"{}\"/></components></object>", id,
        used);
  }
  return Zip(Package(Model(objects, fmt::format("<item objectid=\"{}\"/>", is_built ? 2 : 1))));
}

std::string MakeNested3mf(std::size_t levels) {
  std::string objects;
  for (std::size_t i = 1; i <= levels; ++i) {
    objects += fmt::format(
        "<object id=\"{}\" type=\"model\"><components><component objectid=\"{}\"/></components>"
        "</object>",
        i + 1, i);
  }
  return Zip(Package(Model(objects, fmt::format("<item objectid=\"{}\"/>", levels + 1))));
}

std::string MakeRow3mf(std::size_t count, double step) {
  std::string items;
  for (std::size_t i = 0; i < count; ++i) {
    items += fmt::format("<item objectid=\"1\" transform=\"1 0 0 0 1 0 0 0 1 {:.9g} 0 0\"/>",
                         step * static_cast<double>(i));
  }
  return Zip(Package(Model("", items)));
}

std::string MakeBomb3mf(std::size_t bytes) {
  std::vector<Entry> entries = Package(Model("", "<item objectid=\"1\"/>"));
  entries.push_back({"3D/Textures/bomb.png", "", bytes});
  return Zip(entries);
}

std::string MakeBombModel3mf(std::size_t bytes) {
  return Zip(Package(Model("", "<item objectid=\"1\"/>") + "<!--", bytes));
}

std::string MakeManyNodesGltf(std::size_t count, double step) {
  std::string nodes;
  for (std::size_t i = 0; i < count; ++i) {
    nodes += fmt::format(R"({}{{"mesh":0,"name":"n{}","translation":[{},0,0]}})", i > 0 ? "," : "",
                         i, step * static_cast<double>(i));
  }
  return Gltf(NumbersBelow(count), nodes);
}

std::string MakeDoublingGltf(std::size_t levels) {
  std::string nodes = R"({"mesh":0})";
  for (std::size_t i = 0; i < levels; ++i) {
    nodes += fmt::format(R"(,{{"children":[{},{}]}})", i, i);
  }
  return Gltf(std::to_string(levels), nodes);
}

std::string MakeNestedGltf(std::size_t levels) {
  std::string nodes = R"({"mesh":0})";
  for (std::size_t i = 0; i < levels; ++i) {
    nodes += fmt::format(R"(,{{"children":[{}]}})", i);
  }
  return Gltf(fmt::format("{},{}", levels, levels + 1), nodes + R"(,{"mesh":0})");
}

std::string MakeCircleGltf() {
  return Gltf("0,1", R"({"mesh":0},{"children":[2]},{"children":[1]})");
}

std::string MakeStretchedGltf(std::size_t count) {
  std::string nodes;
  for (std::size_t i = 0; i < count; ++i) {
    nodes += fmt::format(R"({}{{"mesh":0,"scale":[{},1,1]}})", i > 0 ? "," : "",
                         1 + 1e-3 * static_cast<double>(i + 1));
  }
  return Gltf(NumbersBelow(count), nodes);
}

std::string MakeManyObjectsObj(std::size_t count) {
  std::string text = "v 0 0 0\nv 10 0 0\nv 0 10 0\nv 0 0 10\n";
  for (std::size_t i = 0; i < count; ++i) {
    text += fmt::format("o a{}\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n", i);
  }
  return text;
}

std::string MakeManyTrianglesObj(std::size_t count) {
  std::string text;
  for (std::size_t i = 0; i < count; ++i) {
    text += fmt::format("o o{0}\nv {0} 0 0\nv {0} 1 0\nv {0} 0 1\nf -1 -2 -3\n", i);
  }
  return text;
}

std::string MakeManySolidsStl(std::size_t count) {
  std::string solid = "solid a\n";
  for (const char* corners : {"000 010 100", "000 100 001", "000 001 010", "100 010 001"}) {
    solid += "facet normal 0 0 0\nouter loop\n";
    for (const char* c = corners; *c != '\0'; c += c[3] == ' ' ? 4 : 3) {
      solid += fmt::format("vertex {} {} {}\n", c[0], c[1], c[2]);
    }
    solid += "endloop\nendfacet\n";
  }
  return Repeat(solid + "endsolid a\n", count);
}

std::string MakeDoublingStep(const std::string& part, std::size_t levels) {
  const auto references = References(FindEntity(part, "SHAPE_DEFINITION_REPRESENTATION").second);
  std::string definition = FindEntity(part, "PRODUCT_DEFINITION").first;
  std::string shape = references.at(1);
  const std::string placement = FindEntity(part, "AXIS2_PLACEMENT_3D").first;
  const std::string product_context = FindEntity(part, "PRODUCT_CONTEXT").first;
  const std::string definition_context = FindEntity(part, "PRODUCT_DEFINITION_CONTEXT").first;
  // The units stand in a complex entity, which every representation refers to last.
  const std::size_t of_shape = part.find("\n" + shape + " ");
  const auto of_representation =
      References(part.substr(of_shape + 1, part.find(';', of_shape) - of_shape));
  const std::string& context = of_representation.back();
  std::string added;
  std::size_t next = 1'000'000;
  const auto add = [&](const std::string& body) {
    added += fmt::format("#{} = {};\n", ++next, body);
    return fmt::format("#{}", next);
  };
  for (std::size_t i = 1; i <= levels; ++i) {
    const std::string product =
        add(fmt::format("PRODUCT('a{}','a{}','',({}))", i, i, product_context));
    const std::string formation =
        add(fmt::format("PRODUCT_DEFINITION_FORMATION('','',{})", product));
    const std::string own =
        add(fmt::format("PRODUCT_DEFINITION('design','',{},{})", formation, definition_context));
    const std::string own_shape = add(fmt::format("PRODUCT_DEFINITION_SHAPE('','',{})", own));
    const std::string representation =
        add(fmt::format("SHAPE_REPRESENTATION('',({}),{})", placement, context));
    add(fmt::format("SHAPE_DEFINITION_REPRESENTATION({},{})", own_shape, representation));
    for (int k = 0; k < 2; ++k) {
      const std::string usage = add(fmt::format(
          "NEXT_ASSEMBLY_USAGE_OCCURRENCE('u{}_{}','','',{},{},$)", i, k, own, definition));
      const std::string usage_shape = add(fmt::format("PRODUCT_DEFINITION_SHAPE('','',{})", usage));
      const std::string transformation =
          add(fmt::format("ITEM_DEFINED_TRANSFORMATION('','',{},{})", placement, placement));
      const std::string relation =
          add(fmt::format("( REPRESENTATION_RELATIONSHIP('','',{},{}) "
                          "REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION({}) "
                          "SHAPE_REPRESENTATION_RELATIONSHIP() )",
                          shape, representation, transformation));
      add(fmt::format("CONTEXT_DEPENDENT_SHAPE_REPRESENTATION({},{})", relation, usage_shape));
    }
    definition = own;
    shape = representation;
  }
  std::string text = part;
  text.insert(text.rfind("ENDSEC;"), added);
  return text;
}

std::string MakeCircleStep(const std::string& part) {
  std::string text = MakeDoublingStep(part, 2);
  const auto find_usage = [&text](const std::string& name) {
    const std::size_t at = text.find("NEXT_ASSEMBLY_USAGE_OCCURRENCE('" + name + "'");
    return std::pair(at, References(text.substr(at, text.find(';', at) - at)));
  };
  const std::string second = find_usage("u2_0").second.at(0);
  const auto [at, of_first] = find_usage("u1_0");
  text.replace(text.find(of_first.at(1), at), of_first.at(1).size(), second);
  return text;
}

}  // namespace hvas::cad::testing
