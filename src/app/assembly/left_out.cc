#include "app/assembly/left_out.h"

#include <algorithm>

#include <fmt/format.h>

#include "app/assembly/run_report.h"
#include "app/output/text_layout.h"
#include "evidence/gap_picture.h"
#include "pages/embedded_image.h"
#include "pages/html_page.h"

namespace hvas::app {
namespace {

using orders::GapReason;
using sequence::SequenceGap;

/** Why a part is left out, in sentences. */
std::vector<std::string> ListLines(const LeftOut& left_out, const SequenceGap& gap) {
  const GapReason* reason = FindReason(left_out, gap.occurrence);
  return reason != nullptr ? orders::FormatGapReason(*left_out.model, *reason)
                           : std::vector<std::string>{
                                 "it was not looked into: the looks at others took all the time, "
                                 "or it is one too many"};
}

/** Picture of why a part is left out, with what is to be seen; empty where there is none. */
std::string MakePicture(const LeftOut& left_out, const SequenceGap& gap) {
  const GapReason* reason = FindReason(left_out, gap.occurrence);
  const std::string png =
      reason != nullptr ? evidence::MakeGapPicture(*left_out.model, *reason) : std::string();
  if (png.empty()) {
    return {};
  }
  const std::string about = evidence::DescribeGapPicture(*left_out.model, *reason);
  return fmt::format(
      "<figure style=\"max-width:{}px\">{}<figcaption>{}</figcaption></figure>",
      evidence::kGapPictureWidth,
      pages::MakeImage(png, about, evidence::kGapPictureWidth, evidence::kGapPictureHeight),
      pages::Escape(about));
}

std::string MakeSection(const std::string& items) {
  return items.empty() ? items : "<h2 id=\"left-out\">Left out</h2>\n<ul>\n" + items + "</ul>\n";
}

}  // namespace

const GapReason* FindReason(const LeftOut& left_out, product::OccurrenceId id) {
  const auto found =
      std::find_if(left_out.reasons->begin(), left_out.reasons->end(),
                   [id](const GapReason& reason) { return reason.occurrence == id; });
  return found == left_out.reasons->end() ? nullptr : &*found;
}

void PrintLeftOut(const LeftOut& left_out) {
  for (const SequenceGap& gap : left_out.model->sequence.gaps) {
    fmt::print("{}", Wrap(fmt::format("LEFT OUT: {}: {}", PathOf(*left_out.model, gap.occurrence),
                                      gap.reason),
                          0));
    for (const std::string& line : ListLines(left_out, gap)) {
      fmt::print("{}", Wrap(line, 2));
    }
  }
}

std::string MakeLeftOutSection(const LeftOut& left_out) {
  std::string html;
  for (const SequenceGap& gap : left_out.model->sequence.gaps) {
    html += fmt::format("<li><span class=\"bad\">{}</span>: {}",
                        pages::Escape(PathOf(*left_out.model, gap.occurrence)),
                        pages::Escape(gap.reason));
    for (const std::string& line : ListLines(left_out, gap)) {
      html += "<br>" + pages::Escape(line);
    }
    html += MakePicture(left_out, gap) + "</li>\n";
  }
  return MakeSection(html);
}

std::string MakeLeftOutList(const std::vector<std::string>& paths) {
  std::string html;
  for (const std::string& path : paths) {
    html += fmt::format("<li><span class=\"bad\">{}</span></li>\n", pages::Escape(path));
  }
  return MakeSection(html);
}

}  // namespace hvas::app
