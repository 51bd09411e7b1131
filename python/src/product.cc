#include <memory>

#include <fmt/format.h>

#include "arguments.h"

namespace hvas::python {
namespace {

using product::Product;

py::object Describe(const product::Part& part) {
  return MakeDataclass(
      "Part",
      py::dict(py::arg("id") = part.id.index(), py::arg("name") = part.name,
               py::arg("material") = part.material.name, py::arg("density") = part.material.density,
               py::arg("volume") = part.mass.volume, py::arg("mass") = part.mass.mass,
               py::arg("centre_of_mass") = ToTuple(part.mass.p_BoBcm_B),
               py::arg("inertia") = py::make_tuple(ToTuple(Vec3(part.mass.I_BBcm_B.row(0))),
                                                   ToTuple(Vec3(part.mass.I_BBcm_B.row(1))),
                                                   ToTuple(Vec3(part.mass.I_BBcm_B.row(2)))),
               py::arg("box") = py::make_tuple(ToTuple(part.box_B.low), ToTuple(part.box_B.high)),
               py::arg("faces") = part.faces.size(),
               py::arg("triangles") = part.mesh.triangles.size(),
               py::arg("shape_hash") = part.shape_hash));
}

py::object Describe(const product::Feature& feature) {
  return MakeDataclass(
      "Feature",
      py::dict(py::arg("kind") = product::ToString(feature.kind),
               py::arg("origin") = ToTuple(feature.origin_B),
               py::arg("axis") = ToTuple(feature.axis_B), py::arg("radius") = feature.radius,
               py::arg("half_angle") = feature.half_angle,
               py::arg("span") = py::make_tuple(feature.span_low, feature.span_high),
               py::arg("thread") = product::ToString(feature.thread)));
}

py::object Describe(const product::Occurrence& occurrence) {
  return MakeDataclass(
      "Occurrence",
      py::dict(py::arg("id") = occurrence.id.index(), py::arg("part") = occurrence.part.index(),
               py::arg("name") = occurrence.name, py::arg("path") = occurrence.path,
               py::arg("pose") = ToTuple(occurrence.X_WB)));
}

py::object Describe(const Product& product, const product::Mate& mate) {
  py::object fit = py::none();
  if (mate.fit) {
    fit = MakeDataclass("Fit", py::dict(py::arg("kind") = product::ToString(mate.fit->kind),
                                        py::arg("code") = mate.fit->code,
                                        py::arg("nominal") = mate.fit->nominal_diameter,
                                        py::arg("is_proposed") = mate.fit->is_proposed,
                                        py::arg("reason") = mate.fit->reason));
  }
  const product::Occurrence& hole = product.occurrences[mate.a.occurrence.index()];
  const spatial::Pose X_WM = hole.X_WB * mate.a.X_BM;
  return MakeDataclass(
      "Mate",
      py::dict(py::arg("id") = mate.id.index(), py::arg("key") = mate.key,
               py::arg("kind") = product::ToString(mate.kind),
               py::arg("a") = mate.a.occurrence.index(), py::arg("b") = mate.b.occurrence.index(),
               py::arg("fit") = fit, py::arg("frame") = ToTuple(X_WM),
               py::arg("overlap") = mate.overlap, py::arg("confidence") = mate.confidence,
               py::arg("evidence") = mate.evidence));
}

template <typename Items, typename Make>
py::list ListOf(const Items& items, const Make& make) {
  py::list list;
  for (const auto& item : items) {
    list.append(make(item));
  }
  return list;
}

const product::Part& PartOf(const Product& product, const py::object& part) {
  return product.parts[ToIndex("part", part, product.parts.size())];
}

py::array_t<double> Vertices(const Product& product, const py::object& part) {
  const auto& vertices = PartOf(product, part).mesh.vertices;
  py::array_t<double> array({static_cast<py::ssize_t>(vertices.size()), py::ssize_t{3}});
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      array.mutable_at(static_cast<py::ssize_t>(i), k) = vertices[i][k];
    }
  }
  return array;
}

// The numbers where they are: the product lives as long as the array.
py::array Triangles(const py::object& self, const py::object& part) {
  const auto& triangles = PartOf(self.cast<const Product&>(), part).mesh.triangles;
  return py::array_t<std::uint32_t>({static_cast<py::ssize_t>(triangles.size()), py::ssize_t{3}},
                                    triangles.empty() ? nullptr : triangles.front().data(), self);
}

// Files of an export by their paths.
py::dict Export(const Product& product, const std::string& format, const std::string& name) {
  if (product.occurrences.empty()) {
    throw py::value_error("there is no part to export");
  }
  exchange::ExportedProduct exported;
  exchange::ExportedFiles files;
  {
    const py::gil_scoped_release unlocked;
    exported = exchange::MakeExported(product);
    if (format == "urdf") {
      files = exchange::MakeUrdf(exported, name);
    } else {
      files[fmt::format("{}.{}", name, format)] =
          format == "usda" ? exchange::MakeUsda(exported) : exchange::MakeMjcf(exported);
    }
  }
  for (const exchange::ExportedBody& body : exported.bodies) {
    if (body.form.is_hull_only) {
      py::module_::import("warnings")
          .attr("warn")(fmt::format(
              "{}: its surface has too many triangles; it is met as its hull, with holes closed",
              product.occurrences[body.occurrence.index()].path));
    }
  }
  py::dict contents;
  for (const auto& [path, bytes] : files) {
    contents[py::str(path)] = py::bytes(bytes);
  }
  return contents;
}

std::shared_ptr<Product> Open(const std::filesystem::path& file,
                              const std::vector<std::string>& fits, const py::object& unit,
                              const std::string& encoding, const std::vector<std::string>& apart,
                              const std::vector<std::string>& rigid, bool is_cached,
                              const py::object& time_limit, const py::object& progress,
                              py::list* diagnostics) {
  std::stop_source stop;
  assembly::OpenOptions options;
  options.file = file;
  options.fits = fits;
  options.apart = apart;
  options.rigid = rigid;
  if (!unit.is_none()) {
    options.length_unit = ToNumber("unit", unit, kLength);
  }
  options.encoding = encoding;
  options.limits.time = ToNumber("time_limit", time_limit, {0, kMostTime, true});
  options.progress = MakeProgress(progress, &stop);
  options.stop = stop.get_token();
  if (is_cached) {
    options.cache_directory = FileCache::DefaultDirectory();
  }
  Diagnostics found;
  auto product = [&] {
    const py::gil_scoped_release unlocked;
    return assembly::OpenProduct(options, &found);
  }();
  for (const Diagnostic& item : found.items()) {
    diagnostics->append(MakeDataclass(
        "Diagnostic",
        py::dict(py::arg("severity") = hvas::ToString(item.severity), py::arg("code") = item.code,
                 py::arg("entity") = item.entity, py::arg("message") = item.message,
                 py::arg("remedy") = item.remedy)));
  }
  return std::make_shared<Product>(Take(std::move(product)));
}

}  // namespace

void DefineProduct(py::module_* module) {
  py::class_<Product, std::shared_ptr<Product>>(
      *module, "Product", py::dynamic_attr(),
      "A CAD file that is open: parts, where they are, and the mates that were found.")
      .def_readonly("name", &Product::name)
      .def_readonly("source", &Product::source)
      .def_property_readonly("mass", &Product::mass)
      .def_property_readonly("parts",
                             [](const Product& product) {
                               return ListOf(product.parts,
                                             [](const auto& part) { return Describe(part); });
                             })
      .def_property_readonly("occurrences",
                             [](const Product& product) {
                               return ListOf(product.occurrences,
                                             [](const auto& item) { return Describe(item); });
                             })
      .def_property_readonly("mates",
                             [](const Product& product) {
                               return ListOf(product.mates, [&](const product::Mate& mate) {
                                 return Describe(product, mate);
                               });
                             })
      .def(
          "features",
          [](const Product& product, const py::object& part) {
            return ListOf(PartOf(product, part).features,
                          [](const auto& feature) { return Describe(feature); });
          },
          py::arg("part"), "Holes, shafts, planes, cones and spheres of a part.")
      .def("vertices", &Vertices, py::arg("part"), "Array of n x 3 in the part's frame [m].")
      .def("triangles", &Triangles, py::arg("part"),
           "Array of n x 3 indices into vertices, outward: a view that keeps the product alive.")
      .def(
          "export_files", &Export, py::arg("format"), py::arg("name"),
          "Files of an export ('mjcf', 'xml', 'urdf' or 'usda') by their paths; hvas.export writes "
          "them.")
      .def("__repr__", [](const Product& product) {
        return "<hvas.Product " + product.source + ": " +
               std::to_string(product.occurrences.size()) + " parts, " +
               std::to_string(product.mates.size()) + " mates>";
      });
  module->def(
      "open_product",
      [](const std::filesystem::path& file, const std::vector<std::string>& fits,
         const py::object& unit, const std::string& encoding, const std::vector<std::string>& apart,
         const std::vector<std::string>& rigid, bool cache, const py::object& time_limit,
         const py::object& progress) {
        py::list diagnostics;
        auto product = py::cast(Open(file, fits, unit, encoding, apart, rigid, cache, time_limit,
                                     progress, &diagnostics));
        product.attr("diagnostics") = diagnostics;
        return product;
      },
      py::arg("file"), py::arg("fits"), py::arg("unit"), py::arg("encoding"), py::arg("apart"),
      py::arg("rigid"), py::arg("cache").noconvert(), py::arg("time_limit"), py::arg("progress"));
}

}  // namespace hvas::python
