#include "codec/row.hpp"

#include <algorithm>
#include <iterator>

namespace adit::codec {
namespace {

/// Where a member is in a row that is only looked at.
const void* in(const Member& member, const void* row) {
  return member.in(const_cast<void*>(row));  // NOLINT(cppcoreguidelines-pro-type-const-cast)
}

Value text(std::string_view all) {
  return {std::string(all)};
}

void put(Value::Object& object, std::string_view name, Value value) {
  const auto found = std::ranges::find(object, name, &Value::Member::first);
  if (found == object.end()) {
    object.emplace_back(name, std::move(value));
  } else {
    found->second = std::move(value);
  }
}

Value schema_of(const Member& member, Schemas& schemas) {
  Value::Object schema = member.kind->schema(schemas);
  if (!member.words.empty()) {
    Value::Array words;
    for (const std::string_view word : member.words) words.push_back(text(word));
    if (member.kind == &kTextOrNull) words.emplace_back();
    put(schema, "enum", {std::move(words)});
  }
  if (member.least) put(schema, "minimum", {*member.least});
  if (member.most) put(schema, "maximum", {*member.most});
  if (!member.meaning.empty()) put(schema, "description", text(member.meaning));
  return {std::move(schema)};
}

void add_members(const Row& row, Schemas& schemas, Value::Object& properties, Value::Array& required) {
  for (const Member& member : row.members) {
    if (member.name.empty()) {
      add_members(*member.kind->row, schemas, properties, required);
    } else {
      properties.emplace_back(member.name, schema_of(member, schemas));
      required.push_back(text(member.name));
    }
  }
}

Value::Object schema_of(const Row& row, Schemas& schemas) {
  Value::Object properties, schema{{"type", text("object")}};
  Value::Array required;
  add_members(row, schemas, properties, required);
  if (!row.meaning.empty()) schema.emplace_back("description", text(row.meaning));
  schema.emplace_back("properties", Value{std::move(properties)});
  schema.emplace_back("required", Value{std::move(required)});
  schema.emplace_back("additionalProperties", Value{false});
  return schema;
}

constexpr Member kPointMembers[] = {member<&icd::Point::x>("x"), member<&icd::Point::y>("y"),
                                    member<&icd::Point::z>("z")};
constexpr Member kStatusMembers[] = {member<&icd::RunStatus::score>("score"),
                                     member<&icd::RunStatus::run_clock>("run_clock", "seconds"),
                                     member<&icd::RunStatus::remaining_reports>("remaining_reports"),
                                     member<&icd::RunStatus::current_team>("current_team")};

}  // namespace

constinit const Row kPoint = {"Point", kPointMembers, "Metres, in the frame darpa."};
constinit const Row kRunStatus = {"", kStatusMembers, "As last heard."};

constinit const Kind kTextOrNull = {
    .write =
        [](const void* value) {
          const auto& all = *static_cast<const std::string*>(value);
          return all.empty() ? Value{} : Value{all};
        },
    .read = [](const Field& field,
               void* value) { *static_cast<std::string*>(value) = field.is_absent() ? "" : field.text(); },
    .schema = [](Schemas& schemas) { return or_null(KindOf<std::string>::schema(schemas)); },
    .row = nullptr};

Value write_row(const Row& row, const void* from) {
  Value::Object object;
  object.reserve(row.members.size());
  for (const Member& member : row.members) {
    Value value = member.kind->write(in(member, from));
    if (member.name.empty()) {
      std::ranges::move(std::get<Value::Object>(value.is), std::back_inserter(object));
    } else {
      object.emplace_back(member.name, std::move(value));
    }
  }
  return {std::move(object)};
}

void read_row(const Row& row, const Field& field, void* into) {
  for (const Member& member : row.members) {
    if (member.name.empty()) {
      member.kind->read(field, member.in(into));
    } else {
      const Field inner = field.member(member.name);
      member.kind->read(inner, member.in(into));
    }
  }
}

Value::Object Schemas::named(std::string_view name, Value::Object schema) {
  put(all_, name, {std::move(schema)});
  return {{"$ref", text("#/components/schemas/" + std::string(name))}};
}

Value::Object Schemas::of(const Row& row) {
  return row.name.empty() ? schema_of(row, *this) : named(row.name, schema_of(row, *this));
}

Value::Object or_null(Value::Object schema) {
  auto& [name, value] = schema.front();
  const bool is_simple =
      name == "type" && std::ranges::find(schema, "properties", &Value::Member::first) == schema.end();
  if (!is_simple)
    return {{"oneOf", {Value::Array{{Value::Object{{"type", text("null")}}}, {std::move(schema)}}}}};
  value = {Value::Array{std::move(value), text("null")}};
  return schema;
}

}  // namespace adit::codec
