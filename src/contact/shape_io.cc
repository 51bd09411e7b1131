#include "contact/shape_io.h"

#include <bit>
#include <cstdint>
#include <cstring>
#include <type_traits>

#include "contact/shape_data.h"

namespace hvas::contact {
namespace {

static_assert(std::endian::native == std::endian::little,
              "shapes are written as they lie in memory");
// No padding, whose bytes nobody sets.
static_assert(sizeof(SphereNode) == 160 && sizeof(SampleFaces) == 40 && sizeof(ListFaces) == 22);

class Writer {
 public:
  template <typename T>
  void Plain(const T* values, std::size_t count) {
    const auto* begin = reinterpret_cast<const std::byte*>(values);
    bytes_.insert(bytes_.end(), begin, begin + count * sizeof(T));
  }

  template <typename T>
  bool Size(const std::vector<T>* vector) {
    const std::uint64_t size = vector->size();
    Plain(&size, 1);
    return true;
  }

  [[nodiscard]] std::vector<std::byte>& bytes() { return bytes_; }

 private:
  std::vector<std::byte> bytes_;
};

class Reader {
 public:
  explicit Reader(std::span<const std::byte> bytes) : rest_(bytes) {}

  template <typename T>
  void Plain(T* values, std::size_t count) {
    if (is_failed_ || rest_.size() / sizeof(T) < count) {
      is_failed_ = true;
      return;
    }
    if (count > 0) {
      std::memcpy(values, rest_.data(), count * sizeof(T));
      rest_ = rest_.subspan(count * sizeof(T));
    }
  }

  template <typename T>
  bool Size(std::vector<T>* vector) {
    std::uint64_t size = 0;
    Plain(&size, 1);
    // Every element takes at least a byte: a wrong size cannot ask for more memory than that.
    is_failed_ = is_failed_ || size > rest_.size();
    if (!is_failed_) {
      vector->resize(size);
    }
    return !is_failed_;
  }

  [[nodiscard]] bool is_finished() const { return !is_failed_ && rest_.empty(); }

 private:
  std::span<const std::byte> rest_;
  bool is_failed_{false};
};

// Walks through a shape's members in the order of the file; one list for both directions. `Data` is
// const when an archive writes.
template <typename Archive>
class Members {
 public:
  explicit Members(Archive* archive) : archive_(*archive) {}

  template <typename Data>
  void Visit(Data* d) {
    Visit3(&d->box_B.low);
    Visit3(&d->box_B.high);
    Visit3(&d->p_BC);
    One(&d->voxel);
    One(&d->spacing);
    VisitMesh(&d->mesh);
    VisitField(&d->field);
    VisitExact(&d->exact);
    if (archive_.Size(&d->helices)) {
      for (auto& helix : d->helices) {
        VisitHelix(&helix);
      }
    }
    VisitShell(&d->shell);
    VisitShell(&d->features);
  }

 private:
  template <typename T>
  void One(T* value) {
    static_assert(std::is_arithmetic_v<T> || std::is_enum_v<T>);
    archive_.Plain(value, 1);
  }

  template <typename V>
  void Visit3(V* v) {
    archive_.Plain(v->data(), 3);
  }

  template <typename Vector>
  void All(Vector* vector) {
    using T = typename Vector::value_type;
    if (!archive_.Size(vector) || vector->empty()) {
      return;
    }
    if constexpr (std::is_same_v<T, Vec3>) {
      static_assert(sizeof(Vec3) == 3 * sizeof(double));
      archive_.Plain(vector->data()->data(), 3 * vector->size());
    } else {
      static_assert(std::is_trivially_copyable_v<T>);
      archive_.Plain(vector->data(), vector->size());
    }
  }

  template <typename Mesh>
  void VisitMesh(Mesh* m) {
    All(&m->vertices);
    All(&m->triangles);
    All(&m->face);
    All(&m->normals);
    All(&m->neighbour);
    All(&m->edge_kind);
    All(&m->vertex_kind);
    All(&m->vertex_normals);
    All(&m->vertex_faces);
    All(&m->is_vertex_open);
    All(&m->bends);
    One(&m->is_closed);
  }

  template <typename Field>
  void VisitField(Field* f) {
    auto* v = &f->view;
    archive_.Plain(v->blocks, 3);
    archive_.Plain(v->origin, 3);
    One(&v->voxel);
    One(&v->quantum);
    One(&v->band);
    One(&v->beyond);
    archive_.Plain(v->coarse_count, 3);
    archive_.Plain(v->coarse_origin, 3);
    One(&v->coarse_cell);
    archive_.Plain(v->low, 3);
    archive_.Plain(v->high, 3);
    All(&f->top);
    All(&f->nodes);
    All(&f->slack);
    All(&f->coarse);
  }

  template <typename Exact>
  void VisitExact(Exact* e) {
    if (archive_.Size(&e->faces)) {
      for (auto& face : e->faces) {
        One(&face.kind);
        Visit3(&face.origin);
        Visit3(&face.axis);
        One(&face.radius);
        One(&face.second);
        One(&face.outward);
      }
    }
    All(&e->deviation);
    All(&e->zones);
    All(&e->list_begin);
    All(&e->listed);
    One(&e->distance_bits);
    One(&e->distance_unit);
    All(&e->list_faces);
  }

  template <typename AnyHelix>
  void VisitHelix(AnyHelix* h) {
    Visit3(&h->origin);
    Visit3(&h->axis);
    Visit3(&h->u);
    for (auto* value : {&h->pitch, &h->sense, &h->outward, &h->low, &h->high, &h->deviation}) {
      One(value);
    }
    if (archive_.Size(&h->corners)) {
      for (auto& corner : h->corners) {
        One(&corner.z);
        One(&corner.r);
      }
    }
  }

  template <typename AnyShell>
  void VisitShell(AnyShell* s) {
    All(&s->nodes);
    All(&s->x);
    All(&s->y);
    All(&s->z);
    All(&s->leaf_count);
    All(&s->faces);
    All(&s->facing);
    All(&s->triangle);
    One(&s->point_count);
  }

  Archive& archive_;
};

}  // namespace

std::vector<std::byte> SerialiseShape(const Shape& shape) {
  Writer writer;
  writer.bytes().reserve(shape.memory_bytes());
  Members<Writer>(&writer).Visit(&shape.data());
  return std::move(writer.bytes());
}

std::shared_ptr<const Shape> DeserialiseShape(std::span<const std::byte> bytes) {
  Reader reader(bytes);
  auto data = std::make_unique<Shape::Data>();
  Members<Reader>(&reader).Visit(data.get());
  if (!reader.is_finished()) {
    return nullptr;
  }
  data->field.Bind();
  data->shell.Bind();
  data->features.Bind();
  data->Complete();
  return std::make_shared<const Shape>(std::move(data));
}

}  // namespace hvas::contact
