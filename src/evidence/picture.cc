#include "evidence/picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include <zlib.h>

namespace hvas::evidence {
namespace {

constexpr int kSamples = 2;        // along each edge of a pixel
constexpr double kRoom = 0.94;     // of the picture, that the box may fill
constexpr double kSharpCos = 0.8;  // normals that differ by more make an edge
constexpr double kAmbient = 0.42;  // Share of light that falls on what faces away: a choice.
constexpr std::array<double, 3> kMark{0.86, 0.08, 0.12};  // Red of marked faces: a choice.
constexpr int kMostSplits = 12;       // Of a triangle of a part that bends: a choice.
constexpr double kHiddenMark = 0.45;  // Share of red where something hides a marked face: a choice.

/** What is seen at a sample. */
struct Sample {
  double depth{std::numeric_limits<double>::infinity()};
  std::uint32_t occurrence{std::numeric_limits<std::uint32_t>::max()};
  std::array<float, 3> normal{};
  std::array<float, 3> color{};
  /** Depths of the nearest marked faces, one of each group; infinite: none. */
  std::array<double, kMarkGroups> mark_depth{std::numeric_limits<double>::infinity(),
                                             std::numeric_limits<double>::infinity()};

  [[nodiscard]] bool has_mark_of(std::size_t group) const { return !std::isinf(mark_depth[group]); }

  [[nodiscard]] bool has_seen_mark_of(std::size_t group) const {
    return has_mark_of(group) && mark_depth[group] <= depth;
  }

  [[nodiscard]] bool has_mark() const { return has_mark_of(0) || has_mark_of(1); }

  [[nodiscard]] bool has_seen_mark() const { return has_seen_mark_of(0) || has_seen_mark_of(1); }

  [[nodiscard]] bool is_empty() const { return std::isinf(depth); }
};

/** Where a vertex is: in the world, and in the samples of the picture. */
struct Place {
  Vec3 p_W;
  Vec3 p;
};

/** A corner of a triangle of a part that is deformed. */
struct Corner {
  Vec3 p_B;  // As drawn.
  Place place;
};

class Canvas {
 public:
  explicit Canvas(const Projection& projection)
      : projection_(projection),
        width_(kSamples * projection.width()),
        height_(kSamples * projection.height()),
        samples_(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_)) {}

  void Draw(const PictureBody& body, std::uint32_t number) {
    const product::Part& part = *body.part;
    // The mesh for the eye, or where there is none that for contact.
    const bool is_light = !part.display_mesh.triangles.empty();
    const product::Mesh& mesh = is_light ? part.display_mesh : part.mesh;
    mark_group_ = body.mark_group;
    places_.resize(mesh.vertices.size());
    std::transform(mesh.vertices.begin(), mesh.vertices.end(), places_.begin(),
                   [&](const Vec3& v_B) { return PlaceOf(body, v_B); });
    for (std::size_t f = 0; f < part.faces.size(); ++f) {
      const product::Face& face = part.faces[f];
      const product::Color color = body.color.value_or(face.color.value_or(part.color));
      const std::size_t first = is_light ? face.first_display_triangle : face.first_triangle;
      const std::size_t count = is_light ? face.display_triangle_count : face.triangle_count;
      is_marked_ = std::binary_search(body.marked_faces.begin(), body.marked_faces.end(), f);
      for (std::size_t t = first; t < first + count; ++t) {
        const auto& corners = mesh.triangles[t];
        if (body.deform) {
          const auto corner = [&](std::size_t k) {
            return Corner{mesh.vertices[corners[k]], places_[corners[k]]};
          };
          DrawBent(body, {corner(0), corner(1), corner(2)}, kMostSplits, number,
                   {color.r, color.g, color.b});
          continue;
        }
        DrawTriangle({&places_[corners[0]], &places_[corners[1]], &places_[corners[2]]}, number,
                     {color.r, color.g, color.b});
      }
    }
  }

  void Draw(const std::vector<PictureBody>& bodies) {
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      Draw(bodies[i], static_cast<std::uint32_t>(i));
    }
  }

  [[nodiscard]] double RateMarks(std::size_t group) const {
    double marked = 0;
    double seen = 0;
    for (const Sample& sample : samples_) {
      marked += sample.has_mark_of(group) ? 1 : 0;
      seen += sample.has_seen_mark_of(group) ? 1 : 0;
    }
    return marked > 0 ? seen / marked * seen / static_cast<double>(samples_.size()) : 0;
  }

  /** RGBA, row by row, each behind a byte that says it is not filtered, as PNG has them. */
  [[nodiscard]] std::string Develop() const {
    std::string rows;
    for (int y = 0; y < projection_.height(); ++y) {
      rows.push_back('\0');
      for (int x = 0; x < projection_.width(); ++x) {
        DevelopPixel(x, y, &rows);
      }
    }
    return rows;
  }

 private:
  /** Samples from the upper left, and depth away from the eye [m]. */
  [[nodiscard]] Vec3 ProjectToSamples(const Vec3& p_WQ) const {
    Vec3 p = projection_.Project(p_WQ);
    p.head<2>() *= kSamples;
    return p;
  }

  [[nodiscard]] Place PlaceOf(const PictureBody& body, const Vec3& p_B) const {
    const Vec3 p_W = body.X_WB * (body.deform ? body.deform(p_B) : p_B);
    return {p_W, ProjectToSamples(p_W)};
  }

  /** Draws a triangle of a part that is deformed: split in the middle of the edge that is bent
   most, until none is bent by a quarter of a sample. */
  void DrawBent(const PictureBody& body, const std::array<Corner, 3>& corners, int splits,
                std::uint32_t number, const std::array<float, 3>& color) {
    constexpr double kStraight = 0.25;  // [samples]: a choice.
    double most = kStraight;
    std::size_t from = corners.size();
    Corner middle{};
    for (std::size_t k = 0; k < corners.size() && splits > 0; ++k) {
      const Corner& a = corners[k];
      const Corner& b = corners[(k + 1) % corners.size()];
      const Vec3 p_B = 0.5 * (a.p_B + b.p_B);
      const Place place = PlaceOf(body, p_B);
      const double bow = (place.p - 0.5 * (a.place.p + b.place.p)).head<2>().norm();
      if (bow > most) {
        most = bow;
        from = k;
        middle = {p_B, place};
      }
    }
    if (from == corners.size()) {
      DrawTriangle({&corners[0].place, &corners[1].place, &corners[2].place}, number, color);
      return;
    }
    const Corner& u = corners[from];
    const Corner& v = corners[(from + 1) % corners.size()];
    const Corner& w = corners[(from + 2) % corners.size()];
    DrawBent(body, {u, middle, w}, splits - 1, number, color);
    DrawBent(body, {middle, v, w}, splits - 1, number, color);
  }

  void DrawTriangle(const std::array<const Place*, 3>& corners, std::uint32_t occurrence,
                    const std::array<float, 3>& color) {
    const std::array<Vec3, 3> p{corners[0]->p, corners[1]->p, corners[2]->p};
    const double area = (p[1].x() - p[0].x()) * (p[2].y() - p[0].y()) -
                        (p[2].x() - p[0].x()) * (p[1].y() - p[0].y());
    const auto [left, right] = std::minmax({p[0].x(), p[1].x(), p[2].x()});
    const auto [top, bottom] = std::minmax({p[0].y(), p[1].y(), p[2].y()});
    const bool is_outside = right < -1 || bottom < -1 || left > width_ || top > height_;
    if (!(std::abs(area) > 0) || is_outside) {
      return;
    }
    const Vec3& origin_W = corners[0]->p_W;
    const Vec3 normal =
        projection_.Turn((corners[1]->p_W - origin_W).cross(corners[2]->p_W - origin_W))
            .normalized();
    if (!normal.allFinite()) {
      return;
    }
    const int y_end = std::min(height_ - 1, static_cast<int>(std::ceil(bottom)));
    for (int y = std::max(0, static_cast<int>(top)); y <= y_end; ++y) {
      const auto [first, last] = SpanOf(p, y + 0.5);
      for (int x = first; x <= last; ++x) {
        const Vec3 share = SharesAt(p, area, x + 0.5, y + 0.5);
        const double depth = share.x() * p[0].z() + share.y() * p[1].z() + share.z() * p[2].z();
        if (share.minCoeff() >= 0) {
          Put({depth,
               occurrence,
               {static_cast<float>(normal.x()), static_cast<float>(normal.y()),
                static_cast<float>(normal.z())},
               color},
              &samples_[IndexOf(x, y)]);
        }
      }
    }
  }

  /** The samples of a row that may lie in a triangle, first and last: thin triangles have few of
   those that the box around them has. Empty where the last is before the first. */
  [[nodiscard]] std::pair<int, int> SpanOf(const std::array<Vec3, 3>& p, double y) const {
    double low = width_;
    double high = -1;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3& a = p[k];
      const Vec3& b = p[(k + 1) % 3];
      if (std::min(a.y(), b.y()) > y || std::max(a.y(), b.y()) < y) {
        continue;
      }
      const double height = b.y() - a.y();
      const double share = height != 0 ? (y - a.y()) / height : 0;
      const double other = height != 0 ? share : 1;  // A level edge: both of its ends.
      for (const double x : {a.x() + share * (b.x() - a.x()), a.x() + other * (b.x() - a.x())}) {
        low = std::min(low, x);
        high = std::max(high, x);
      }
    }
    // One more on each side than rounding may cost.
    const double most = width_ - 1;
    return {static_cast<int>(std::clamp(low - 1.5, 0.0, most + 1)),
            static_cast<int>(std::clamp(high + 1.5, -1.0, most))};
  }

  void Put(const Sample& drawn, Sample* sample) const {
    std::array<double, kMarkGroups> mark_depth = sample->mark_depth;
    if (is_marked_) {
      mark_depth[mark_group_] = std::min(mark_depth[mark_group_], drawn.depth);
    }
    if (drawn.depth < sample->depth) {
      *sample = drawn;
    }
    sample->mark_depth = mark_depth;
  }

  /** Barycentric coordinates. */
  [[nodiscard]] static Vec3 SharesAt(const std::array<Vec3, 3>& p, double area, double x,
                                     double y) {
    const auto cross = [&](const Vec3& a, const Vec3& b) {
      return (a.x() - x) * (b.y() - y) - (b.x() - x) * (a.y() - y);
    };
    return Vec3(cross(p[1], p[2]), cross(p[2], p[0]), cross(p[0], p[1])) / area;
  }

  [[nodiscard]] std::size_t IndexOf(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
           static_cast<std::size_t>(x);
  }

  [[nodiscard]] bool IsEdge(int x, int y) const {
    const Sample& here = samples_[IndexOf(x, y)];
    const auto differs = [&](int other_x, int other_y) {
      if (other_x >= width_ || other_y >= height_) {
        return false;
      }
      const Sample& other = samples_[IndexOf(other_x, other_y)];
      float cosine = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        cosine += here.normal[k] * other.normal[k];
      }
      return here.occurrence != other.occurrence ||
             (!here.is_empty() && static_cast<double>(cosine) < kSharpCos);
    };
    return differs(x + 1, y) || differs(x, y + 1);
  }

  void DevelopPixel(int x, int y, std::string* rows) const {
    std::array<double, 4> sum{};
    for (int k = 0; k < kSamples * kSamples; ++k) {
      const int sample_x = kSamples * x + k % kSamples;
      const int sample_y = kSamples * y + k / kSamples;
      const Sample& sample = samples_[IndexOf(sample_x, sample_y)];
      if (sample.is_empty()) {
        continue;
      }
      // Light from the upper left, behind the eye.
      const Vec3 light = Vec3(-0.4, 0.6, 0.7).normalized();
      const double facing = std::abs(light.x() * static_cast<double>(sample.normal[0]) +
                                     light.y() * static_cast<double>(sample.normal[1]) +
                                     light.z() * static_cast<double>(sample.normal[2]));
      const double shade = IsEdge(sample_x, sample_y) ? 0.25 : kAmbient + (1 - kAmbient) * facing;
      const double red = sample.has_seen_mark() ? 1 : sample.has_mark() ? kHiddenMark : 0;
      for (std::size_t c = 0; c < 3; ++c) {
        sum[c] += shade * ((1 - red) * static_cast<double>(sample.color[c]) + red * kMark[c]);
      }
      sum[3] += 1;
    }
    for (std::size_t c = 0; c < 3; ++c) {
      const double mean = sum[3] > 0 ? sum[c] / sum[3] : 0;
      rows->push_back(static_cast<char>(std::lround(255 * std::clamp(mean, 0.0, 1.0))));
    }
    rows->push_back(static_cast<char>(std::lround(255 * sum[3] / (kSamples * kSamples))));
  }

  const Projection& projection_;
  int width_;
  int height_;
  bool is_marked_{false};      // The face that is being drawn.
  std::size_t mark_group_{0};  // That of the body that is being drawn.
  std::vector<Sample> samples_;
  std::vector<Place> places_;  // Those of the vertices of the body that is drawn.
};

void AppendNumber(std::uint32_t value, std::string* bytes) {
  for (int shift = 24; shift >= 0; shift -= 8) {
    bytes->push_back(static_cast<char>(value >> shift & 0xffU));
  }
}

/** A PNG chunk: length, kind, content, checksum of the last two. */
void AppendChunk(const std::string& kind, const std::string& content, std::string* png) {
  const std::string body = kind + content;
  AppendNumber(static_cast<std::uint32_t>(content.size()), png);
  *png += body;
  const uLong sum =
      crc32(0, reinterpret_cast<const Bytef*>(body.data()), static_cast<uInt>(body.size()));
  AppendNumber(static_cast<std::uint32_t>(sum), png);
}

std::string MakePng(const std::string& rows, int width, int height) {
  uLongf size = compressBound(rows.size());
  std::string packed(size, '\0');
  compress2(reinterpret_cast<Bytef*>(packed.data()), &size,
            reinterpret_cast<const Bytef*>(rows.data()), rows.size(), Z_BEST_COMPRESSION);
  packed.resize(size);
  std::string head;
  AppendNumber(static_cast<std::uint32_t>(width), &head);
  AppendNumber(static_cast<std::uint32_t>(height), &head);
  head += std::string("\x08\x06\0\0\0", 5);  // 8 bits, RGBA, nothing special
  std::string png = "\x89PNG\r\n\x1a\n";
  AppendChunk("IHDR", head, &png);
  AppendChunk("IDAT", packed, &png);
  AppendChunk("IEND", "", &png);
  return png;
}

}  // namespace

Vec3 UsualView() {
  return Vec3(0.75, -1.0, 0.7).normalized();
}

Projection::Projection(const spatial::Box& box_W, int width, int height, const Vec3& to_eye_W)
    : centre_W_(box_W.centre()), width_(width), height_(height) {
  const Vec3 to_eye = to_eye_W.normalized();
  const Vec3 right = Vec3::UnitZ().cross(to_eye).normalized();
  R_VW_.row(0) = right.transpose();
  R_VW_.row(1) = to_eye.cross(right).transpose();
  R_VW_.row(2) = to_eye.transpose();
  const Vec3 half = 0.5 * box_W.size();
  const double half_x = R_VW_.row(0).cwiseAbs().dot(half.transpose());
  const double half_y = R_VW_.row(1).cwiseAbs().dot(half.transpose());
  constexpr double kLeast = 1e-9;  // [m]; a box may be a point
  scale_ =
      0.5 * kRoom * std::min(width / std::max(half_x, kLeast), height / std::max(half_y, kLeast));
}

std::string MakePicture(const std::vector<PictureBody>& bodies, const Projection& projection) {
  Canvas canvas(projection);
  canvas.Draw(bodies);
  return MakePng(canvas.Develop(), projection.width(), projection.height());
}

std::vector<std::uint8_t> DrawPixels(const std::vector<PictureBody>& bodies,
                                     const Projection& projection) {
  Canvas canvas(projection);
  canvas.Draw(bodies);
  const std::string rows = canvas.Develop();  // Each behind the byte of its filter.
  const std::size_t length = 4 * static_cast<std::size_t>(projection.width());
  std::vector<std::uint8_t> pixels;
  for (std::size_t at = 1; at < rows.size(); at += length + 1) {
    pixels.insert(pixels.end(), rows.begin() + static_cast<std::ptrdiff_t>(at),
                  rows.begin() + static_cast<std::ptrdiff_t>(at + length));
  }
  return pixels;
}

spatial::Box BoxAround(const std::vector<PictureBody>& bodies) {
  spatial::Box box_W;
  for (const PictureBody& body : bodies) {
    box_W.Add(spatial::Transform(body.X_WB, body.part->box_B));
  }
  return box_W;
}

std::array<double, kMarkGroups> RateMarks(const std::vector<PictureBody>& bodies,
                                          const Projection& projection) {
  Canvas canvas(projection);
  canvas.Draw(bodies);
  return {canvas.RateMarks(0), canvas.RateMarks(1)};
}

std::string MakePicture(const product::Product& product, const Projection& projection) {
  std::vector<PictureBody> bodies;
  bodies.reserve(product.occurrences.size());
  for (const product::Occurrence& occurrence : product.occurrences) {
    bodies.push_back({&product.part_of(occurrence.id), occurrence.X_WB, std::nullopt, {}});
  }
  return MakePicture(bodies, projection);
}

}  // namespace hvas::evidence
