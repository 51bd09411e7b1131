#include "cad/step/identities.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "cad/step/text_encoding.h"

namespace hvas::cad {
namespace {

using product::FileHeader;
using product::Identity;
using EntityId = std::uint64_t;
using Kind = StepValue::Kind;

constexpr std::size_t kHeaderSize = 1 << 16;  // [bytes] in which the header section ends: a choice.

/** The type of an entity in one record, without parsing it; empty for complex instances. */
std::string_view TypeOf(std::string_view body) {
  const std::size_t begin = body.find_first_not_of(" \t\r\n");
  if (begin == std::string_view::npos) {
    return {};
  }
  std::size_t end = begin;
  while (end < body.size() && body[end] != '(' && !IsBlank(body[end])) {
    ++end;
  }
  return body.substr(begin, end - begin);
}

std::string TextOf(const StepValue& value) {
  return value.kind == Kind::kText ? CleanName(DecodeStepText(value.text)) : std::string();
}

std::string TextAt(const std::vector<StepValue>& values, std::size_t index) {
  return index < values.size() ? TextOf(values[index]) : std::string();
}

EntityId ReferenceAt(const std::vector<StepValue>& values, std::size_t index) {
  return index < values.size() && values[index].kind == Kind::kReference ? values[index].reference
                                                                         : 0;
}

std::optional<double> NumberAt(const std::vector<StepValue>& values, std::size_t index) {
  return index < values.size() && values[index].kind == Kind::kNumber
             ? std::optional(values[index].number)
             : std::nullopt;
}

void Append(const std::string& text, std::string* list) {
  if (!text.empty()) {
    *list += (list->empty() ? "" : ", ") + text;
  }
}

/** The texts of a list, joined; of one value, its text. */
std::string JoinTexts(const std::vector<StepValue>& values, std::size_t index) {
  if (index >= values.size()) {
    return {};
  }
  std::string joined = TextOf(values[index]);
  for (const StepValue& item : values[index].items) {
    Append(TextOf(item), &joined);
  }
  return joined;
}

/** Who or when, assigned to an item. */
struct Assignment {
  std::string role;
  std::string person, organisation;  // One of an assignment of persons.
  std::string date;                  // Or this.
};

class IdentityReader {
 public:
  explicit IdentityReader(const StepText& text) : text_(text) {}

  std::map<EntityId, Identity> Read();

 private:
  [[nodiscard]] std::vector<StepValue> ValuesOf(EntityId id, std::string_view type) const;
  void ReadAssignment(const StepRecord& record, bool is_date);
  [[nodiscard]] std::string ReadRole(EntityId id) const;
  [[nodiscard]] std::string ReadPerson(EntityId id) const;
  [[nodiscard]] std::string ReadDate(EntityId id) const;
  [[nodiscard]] std::string ReadTime(EntityId id) const;
  [[nodiscard]] Identity MakeIdentity(EntityId definition) const;
  void AddAssignments(const std::array<EntityId, 3>& items, Identity* identity) const;

  const StepText& text_;
  std::vector<EntityId> definitions_;
  std::vector<Assignment> assignments_;
  std::map<EntityId, std::vector<std::size_t>> assigned_to_;  // Indices into assignments_.
};

/** The values of an entity's record whose type begins with `type` (subtypes have longer names). */
std::vector<StepValue> IdentityReader::ValuesOf(EntityId id, std::string_view type) const {
  StepEntity entity = id != 0 ? text_.Find(id) : StepEntity();
  for (StepRecord& record : entity) {
    if (std::string_view(record.name).substr(0, type.size()) == type) {
      return std::move(record.values);
    }
  }
  return {};
}

std::string IdentityReader::ReadRole(EntityId id) const {
  std::vector<StepValue> values = ValuesOf(id, "PERSON_AND_ORGANIZATION_ROLE");
  if (values.empty()) {
    values = ValuesOf(id, "DATE_");  // DATE_TIME_ROLE, DATE_ROLE.
  }
  return TextAt(values, 0);
}

/** "Given Family", or the person's id where there is no name. */
std::string IdentityReader::ReadPerson(EntityId id) const {
  const std::vector<StepValue> person = ValuesOf(id, "PERSON");
  std::string name = TextAt(person, 2);
  const std::string family = TextAt(person, 1);
  name += (name.empty() || family.empty() ? "" : " ") + family;
  return name.empty() ? TextAt(person, 0) : name;
}

/** "2024-05-31", of a CALENDAR_DATE (year, day, month). */
std::string IdentityReader::ReadDate(EntityId id) const {
  const std::vector<StepValue> date = ValuesOf(id, "CALENDAR_DATE");
  const auto year = NumberAt(date, 0);
  const auto day = NumberAt(date, 1);
  const auto month = NumberAt(date, 2);
  const auto is_in = [](const std::optional<double>& number, double low, double high) {
    return number && *number >= low && *number <= high;
  };
  return is_in(year, 0, 9999) && is_in(month, 1, 12) && is_in(day, 1, 31)
             ? fmt::format("{:04.0f}-{:02.0f}-{:02.0f}", *year, *month, *day)
             : std::string();
}

/** "T12:30:00", of a LOCAL_TIME (hour, minute, second, zone). */
std::string IdentityReader::ReadTime(EntityId id) const {
  const std::vector<StepValue> time = ValuesOf(id, "LOCAL_TIME");
  const auto hour = NumberAt(time, 0);
  if (!hour || *hour < 0 || *hour > 24) {
    return {};
  }
  const auto within = [](std::optional<double> number) {
    return std::clamp(number.value_or(0), 0.0, 59.0);
  };
  return fmt::format("T{:02.0f}:{:02.0f}:{:02.0f}", *hour, within(NumberAt(time, 1)),
                     std::floor(within(NumberAt(time, 2))));
}

/** "(assigned, role, items)" of any kind of assignment of persons or dates. */
void IdentityReader::ReadAssignment(const StepRecord& record, bool is_date) {
  if (record.values.size() < 3) {
    return;
  }
  Assignment assignment;
  assignment.role = ReadRole(ReferenceAt(record.values, 1));
  const EntityId assigned = ReferenceAt(record.values, 0);
  if (is_date) {
    const std::vector<StepValue> moment = ValuesOf(assigned, "DATE_AND_TIME");
    assignment.date = moment.empty() ? ReadDate(assigned) : ReadDate(ReferenceAt(moment, 0));
    assignment.date += assignment.date.empty() ? "" : ReadTime(ReferenceAt(moment, 1));
  } else {
    const std::vector<StepValue> pair = ValuesOf(assigned, "PERSON_AND_ORGANIZATION");
    assignment.person = ReadPerson(ReferenceAt(pair, 0));
    assignment.organisation = TextAt(ValuesOf(ReferenceAt(pair, 1), "ORGANIZATION"), 1);
  }
  for (const StepValue& item : record.values[2].items) {
    if (item.kind == Kind::kReference) {
      assigned_to_[item.reference].push_back(assignments_.size());
    }
  }
  assignments_.push_back(std::move(assignment));
}

void IdentityReader::AddAssignments(const std::array<EntityId, 3>& items,
                                    Identity* identity) const {
  static constexpr std::array<std::string_view, 3> kMakers{"creator", "design_owner", "author"};
  static constexpr std::array<std::string_view, 2> kOthers{"approver", "classification_officer"};
  const auto has = [](const auto& roles, const std::string& role) {
    return std::find(roles.begin(), roles.end(), role) != roles.end();
  };
  std::vector<const Assignment*> all;
  for (const EntityId item : items) {
    if (const auto found = assigned_to_.find(item); found != assigned_to_.end()) {
      for (const std::size_t index : found->second) {
        all.push_back(&assignments_[index]);
      }
    }
  }
  const bool has_maker = std::any_of(all.begin(), all.end(), [&](const Assignment* assignment) {
    return has(kMakers, assignment->role) && !assignment->person.empty();
  });
  std::set<std::string> known;
  for (const Assignment* assignment : all) {
    const std::string& date = assignment->date;
    if (!date.empty() && (identity->created.empty() || date < identity->created)) {
      identity->created = date;
    }
    if (has_maker ? !has(kMakers, assignment->role) : has(kOthers, assignment->role)) {
      continue;
    }
    if (known.insert("p" + assignment->person).second) {
      Append(assignment->person, &identity->designer);
    }
    if (known.insert("o" + assignment->organisation).second) {
      Append(assignment->organisation, &identity->organisation);
    }
  }
}

Identity IdentityReader::MakeIdentity(EntityId definition) const {
  const std::vector<StepValue> values = ValuesOf(definition, "PRODUCT_DEFINITION");
  const EntityId formation = ReferenceAt(values, 2);
  const std::vector<StepValue> version = ValuesOf(formation, "PRODUCT_DEFINITION_FORMATION");
  const EntityId product = ReferenceAt(version, 2);
  const std::vector<StepValue> item = ValuesOf(product, "PRODUCT");
  Identity identity;
  identity.id = TextAt(item, 0);
  identity.description = TextAt(item, 2);
  identity.version = TextAt(version, 0);
  identity.version_description = TextAt(version, 1);
  AddAssignments({definition, formation, product}, &identity);
  return identity;
}

std::map<EntityId, Identity> IdentityReader::Read() {
  const auto ends_with = [](std::string_view text, std::string_view end) {
    return text.size() >= end.size() && text.substr(text.size() - end.size()) == end;
  };
  for (const StepText::Statement& statement : text_.statements()) {
    const std::string_view type = TypeOf(statement.body);
    const bool is_person = ends_with(type, "PERSON_AND_ORGANIZATION_ASSIGNMENT");
    const bool is_date =
        ends_with(type, "DATE_AND_TIME_ASSIGNMENT") || ends_with(type, "DATE_ASSIGNMENT");
    if (type == "PRODUCT_DEFINITION" || type == "PRODUCT_DEFINITION_WITH_ASSOCIATED_DOCUMENTS") {
      definitions_.push_back(statement.id);
    } else if (is_person || is_date) {
      for (const StepRecord& record : ParseStepEntity(statement.body)) {
        ReadAssignment(record, is_date);
      }
    }
  }
  std::map<EntityId, Identity> identities;
  for (const EntityId definition : definitions_) {
    Identity identity = MakeIdentity(definition);
    if (!identity.is_empty()) {
      identities.emplace(definition, std::move(identity));
    }
  }
  return identities;
}

/** The values of a record of the header section; none where it is not there. */
std::vector<StepValue> FindHeaderRecord(std::string_view header, std::string_view name) {
  const std::size_t begin = header.find(name);
  if (begin == std::string_view::npos) {
    return {};
  }
  StepEntity entity = ParseStepEntity(header.substr(begin));
  return entity.size() == 1 && entity.front().name == name ? std::move(entity.front().values)
                                                           : std::vector<StepValue>();
}

}  // namespace

std::map<std::uint64_t, Identity> ReadIdentities(const StepText& text) {
  return IdentityReader(text).Read();
}

FileHeader ReadStepHeader(std::string_view step_text) {
  std::string_view text = step_text.substr(0, kHeaderSize);
  text = text.substr(0, text.find("ENDSEC"));
  FileHeader header;
  header.format = "STEP";
  header.description = JoinTexts(FindHeaderRecord(text, "FILE_DESCRIPTION"), 0);
  const std::vector<StepValue> name = FindHeaderRecord(text, "FILE_NAME");
  header.name = TextAt(name, 0);
  header.time_stamp = TextAt(name, 1);
  header.authors = JoinTexts(name, 2);
  header.organisations = JoinTexts(name, 3);
  header.preprocessor = TextAt(name, 4);
  header.originating_system = TextAt(name, 5);
  header.authorisation = TextAt(name, 6);
  header.schema = JoinTexts(FindHeaderRecord(text, "FILE_SCHEMA"), 0);
  return header;
}

}  // namespace hvas::cad
