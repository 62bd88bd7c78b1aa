#include "api/description.hpp"

#include <algorithm>
#include <cassert>
#include <ranges>
#include <utility>
#include <vector>

#include "api/description_files.hpp"
#include "codec/json.hpp"

namespace adit::api {
namespace {

using codec::Value;
using Object = Value::Object;

Value text(std::string_view words) {
  return {std::string(words)};
}

Object& members(Value& object) {
  return std::get<Object>(object.is);
}

const Value* member(const Value& object, std::string_view name) {
  const auto& all = std::get<Object>(object.is);
  const auto found = std::ranges::find(all, name, &Value::Member::first);
  return found == all.end() ? nullptr : &found->second;
}

/// What is embedded names all that the routes name: a test asks for the whole.
const Value& known(const Value& object, std::string_view name) {
  const Value* const found = member(object, name);
  assert(found != nullptr);
  return *found;
}

Value take(Value& object, std::string_view name) {
  auto& all = members(object);
  const auto found = std::ranges::find(all, name, &Value::Member::first);
  Value taken = std::move(found->second);
  all.erase(found);
  return taken;
}

std::vector<std::string_view> words_of(std::string_view list) {
  std::vector<std::string_view> words;
  for (const auto word : std::views::split(list, ' ')) {
    if (!word.empty()) words.emplace_back(word.begin(), word.end());
  }
  return words;
}

Value reference(std::string_view kind, std::string_view name) {
  return {Object{{"$ref", text("#/components/" + std::string(kind) + "/" + std::string(name))}}};
}

Value content(std::string_view type, Value of) {
  return {Object{{std::string(type), std::move(of)}}};
}

Value json_content(Value schema) {
  return content("application/json", {Object{{"schema", std::move(schema)}}});
}

Value described(std::string_view words, Value content) {
  return {Object{{"description", text(words)}, {"content", std::move(content)}}};
}

/// An object of these members and no others.
Value closed(const Value& properties) {
  Value::Array required;
  for (const auto& [name, schema] : std::get<Object>(properties.is)) required.push_back(text(name));
  return {Object{{"type", text("object")},
                 {"properties", properties},
                 {"required", {std::move(required)}},
                 {"additionalProperties", {false}}}};
}

class Description {
 public:
  Description()
      : whole_(codec::parse_json(open_api::embedded_files()[0].body).value()),
        schemas_(codec::parse_json(open_api::embedded_files()[1].body).value()),
        refusals_(take(whole_, "refusals")),
        parameters_(take(whole_, "parameters")),
        bodies_(take(whole_, "bodies")),
        answers_(take(whole_, "answers")) {}

  std::string of(std::span<const Route> routes) {
    Object paths;
    for (const Route& route : routes) {
      if (paths.empty() || paths.back().first != route.path) {
        paths.emplace_back(std::string(route.path), Value{Object{}});
      }
      members(paths.back().second).emplace_back(route.method == "GET" ? "get" : "post", operation(route));
    }
    members(whole_).emplace_back("paths", Value{std::move(paths)});
    Object responses;
    for (auto& [status, response] : members(refusals_)) {
      members(response).emplace_back("content", json_content(reference("schemas", "Error")));
      responses.emplace_back(status, std::move(response));
    }
    Object& components =
        members(std::ranges::find(members(whole_), "components", &Value::Member::first)->second);
    components.emplace_back("responses", Value{std::move(responses)});
    components.emplace_back("schemas", std::move(schemas_));
    return codec::write_json(whole_);
  }

 private:
  Value operation(const Route& route) const {
    Object operation{{"tags", {Value::Array{text(route.words.tag)}}}, {"summary", text(route.words.summary)}};
    if (route.who <= Who::OwnPage) {
      operation.emplace_back("security", Value{Value::Array{}});
    } else {
      operation.emplace_back("x-adit-role", text(route.who == Who::Viewer ? "viewer" : "operator"));
    }
    Value::Array parameters;
    for (const auto name : words_of(route.words.parameters)) parameters.push_back(known(parameters_, name));
    if (!parameters.empty()) operation.emplace_back("parameters", Value{std::move(parameters)});
    if (!route.body.type.empty()) operation.emplace_back("requestBody", body(route));
    operation.emplace_back("responses", responses(route));
    return {std::move(operation)};
  }

  /// It may be left out where nothing in it is required.
  Value body(const Route& route) const {
    Value rest = known(bodies_, route.words.takes);
    const Value& schema = known(rest, "schema");
    const bool required = route.body.as_it_comes || member(schema, "required") || member(schema, "$ref");
    Object body{{"required", {required}}};
    if (member(rest, "description")) body.emplace_back("description", take(rest, "description"));
    body.emplace_back("content", content(route.body.type, std::move(rest)));
    return {std::move(body)};
  }

  Value responses(const Route& route) const {
    const auto gives = words_of(route.words.gives);
    const bool has_status = gives.front() == "202";
    Object responses{{has_status ? "202" : "200",
                      described(route.words.done, answer(route.words.gives.substr(has_status ? 4 : 0)))}};
    auto statuses = words_of(route.words.refusals);
    if (route.who != Who::Open) statuses.emplace_back("403");
    if (route.who >= Who::OperatorOrSetUp) statuses.emplace_back("401");
    if (!route.body.type.empty()) statuses.emplace_back("422");
    std::ranges::sort(statuses);
    for (const auto status : statuses) responses.emplace_back(status, reference("responses", status));
    return {std::move(responses)};
  }

  Value answer(std::string_view gives) const {
    if (gives == "text/event-stream") {
      return content(gives, {Object{{"x-event", reference("schemas", "RunView")}}});
    }
    if (gives.contains('/')) return content(gives, {Object{}});
    if (gives.starts_with('[')) {
      return json_content({Object{{"type", text("array")},
                                  {"items", reference("schemas", gives.substr(1, gives.size() - 2))}}});
    }
    if (member(schemas_, gives)) return json_content(reference("schemas", gives));
    const Value& schema = known(answers_, gives);
    const Value* const type = member(schema, "type");
    return json_content(type && std::holds_alternative<std::string>(type->is) ? schema : closed(schema));
  }

  Value whole_, schemas_, refusals_, parameters_, bodies_, answers_;
};

}  // namespace

std::string write_description(std::span<const Route> routes) {
  return Description().of(routes);
}

}  // namespace adit::api
