#pragma once

#include <array>
#include <concepts>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>

#include "codec/cbor.hpp"
#include "codec/field.hpp"
#include "icd/geometry.hpp"
#include "icd/mapping.hpp"
#include "icd/members.hpp"
#include "icd/robot_name.hpp"
#include "icd/rules.hpp"

/// Parts of messages with rules of their own.
namespace adit::codec {

/// The optional "header" of a message (ICD 6.1, 6.2). In ROS a frame_id "" means absent.
icd::Header read_header(const Field& message, const icd::Rules& rules);

/// Always writes frame_id, because some servers reject a message without a header.
void write_header(CborWriter& out, const icd::Header& header);

icd::MarkerAction read_action(const Field& field);

/// Replaces an alias by its name. Refuses and returns std::nullopt if the text is not a robot's name (ICD 2).
std::optional<icd::RobotName> read_robot_name(const Field& field, const icd::Rules& rules);

// Parts of a message, each member described once: name, kind, bounds, and whether it may be absent. Reading
// JSON and CBOR and writing CBOR use the description.

/// Whether a member may be absent. An absent one has the struct's default.
enum class Presence : std::uint8_t {
  Always,
  MayLack,  // optional, always written
  IfSaid,   // optional, written only if it differs from the default
  ToAdd,    // required for markers that are added
};

/// The members of a struct as a tuple. Each reads itself from its parent's Field and writes itself.
template <class Struct>
inline constexpr std::nullptr_t members_of = nullptr;

/// The number of the struct's members that are in no message.
template <class Struct>
inline constexpr std::size_t kUnsent = 0;

template <class T>
using BoundOf =
    std::conditional_t<std::is_enum_v<T>, std::uint8_t,
                       std::conditional_t<std::is_arithmetic_v<T> && !std::same_as<T, bool>, T, std::size_t>>;

/// A member with the same place in struct and message.
template <class Struct, class T>
struct NamedMember {
  static constexpr std::size_t kCount = 1;  // of the struct's members
  using Bound = BoundOf<T>;
  using Limits = std::numeric_limits<Bound>;

  std::string_view name;
  T Struct::* at;
  Presence need = Presence::Always;
  Bound least = Limits::has_infinity ? -Limits::infinity() : Limits::lowest();  // of a number
  Bound most = Limits::has_infinity ? Limits::infinity() : Limits::max();       // of a number, count, length
  std::string_view unit = "";  // of `most` in a sentence: " bytes"
  bool is_time = false;        // Field::seconds()

  /// A copy with one property changed.
  template <class Value>
  constexpr NamedMember with(Value NamedMember::* which, Value value) const {
    NamedMember other = *this;
    other.*which = value;
    return other;
  }
  constexpr NamedMember needed(Presence when) const { return with(&NamedMember::need, when); }
  constexpr NamedMember from(Bound bound) const { return with(&NamedMember::least, bound); }
  constexpr NamedMember to(Bound bound, std::string_view of = "") const {
    return with(&NamedMember::most, bound).with(&NamedMember::unit, of);
  }
  constexpr NamedMember time_to(Bound longest) const { return to(longest).with(&NamedMember::is_time, true); }

  void read(const Field& parent, Struct& into, const icd::Rules& rules) const {
    const Field field = parent.member(name);
    if (!field.is_absent() || is_needed(into)) read_value(field, into.*at, rules);
  }

  bool is_written(const Struct& from) const {
    if constexpr (requires { (from.*at).has_value(); })
      return (from.*at).has_value();
    else
      return need != Presence::IfSaid || from.*at != T();
  }
  std::size_t count_written(const Struct& from) const { return is_written(from) ? 1 : 0; }
  void write(CborWriter& out, const Struct& from) const {
    if (!is_written(from)) return;
    out.text(name);
    write_value(out, from.*at);
  }

 private:
  bool is_needed(const Struct& into) const {
    if constexpr (requires { into.action; }) {
      if (need == Presence::ToAdd) return into.action == icd::MarkerAction::Add;
    }
    return need == Presence::Always;
  }

  template <class Value>
  void read_value(const Field& field, Value& value, const icd::Rules& rules) const {
    if constexpr (std::same_as<Value, bool>) {
      value = field.truth();
    } else if constexpr (std::floating_point<Value>) {
      value = is_time ? field.seconds(most) : field.float32(least, most);
    } else if constexpr (std::is_enum_v<Value>) {
      value = static_cast<Value>(field.integer<Bound>(least, most));
    } else if constexpr (std::integral<Value>) {
      value = field.integer<Value>(least, most);
    } else if constexpr (std::same_as<Value, std::string>) {
      const std::string_view text = field.text();
      if (text.size() > most) return field.refuse("expected at most ", most, unit, ", got ", text.size());
      value = text;
    } else if constexpr (requires { value.emplace_back(); }) {
      const std::size_t count = field.size();
      if (count > most) return field.refuse("expected at most ", most, unit, ", got ", count);
      value.reserve(count);
      for (std::size_t i = 0; i < count && !field.reading().has_refusal(); ++i) {
        if (read_reals(field, i, value.emplace_back())) continue;
        const Field element = field.element(i);
        read_members(element, value.back(), rules);
      }
    } else if constexpr (requires { value.emplace(); }) {
      read_members(field, value.emplace(), rules);
    } else {
      read_members(field, value, rules);
    }
  }

  template <class Value>
  static void write_value(CborWriter& out, const Value& value) {
    if constexpr (std::same_as<Value, bool>) {
      out.boolean(value);
    } else if constexpr (std::floating_point<Value>) {
      out.floating(value);
    } else if constexpr (std::is_enum_v<Value> || std::integral<Value>) {
      out.integer(static_cast<std::int64_t>(value));
    } else if constexpr (std::same_as<Value, std::string>) {
      out.text(value);
    } else if constexpr (requires { value.begin(); }) {
      out.array(value.size());
      for (const auto& each : value) write_struct(out, each);
    } else if constexpr (requires { value.has_value(); }) {
      write_struct(out, *value);
    } else {
      write_struct(out, value);
    }
  }
};

template <class Struct, class T>
constexpr NamedMember<Struct, T> named(std::string_view name, T Struct::* at) {
  return {name, at};
}

/// Members of a struct that are a nested object in the message.
template <class... Members>
struct Group {
  static constexpr std::size_t kCount = (Members::kCount + ...);
  std::string_view name;
  std::tuple<Members...> members;

  template <class Struct>
  void read(const Field& parent, Struct& into, const icd::Rules& rules) const {
    const Field field = parent.member(name);
    std::apply([&](const auto&... each) { (each.read(field, into, rules), ...); }, members);
  }
  static std::size_t count_written(const auto& /*from*/) { return 1; }
  template <class Struct>
  void write(CborWriter& out, const Struct& from) const {
    out.text(name);
    std::apply(
        [&](const auto&... each) {
          out.map((each.count_written(from) + ...));
          (each.write(out, from), ...);
        },
        members);
  }
};

/// The names of a struct's members if all are required numbers; otherwise empty.
template <class Struct>
inline constexpr auto kNamesOfReals = std::apply(
    []<class... Members>(const Members&... each) {
      if constexpr ((std::same_as<Members, NamedMember<Struct, double>> && ...))
        return std::array<std::string_view, sizeof...(Members)>{each.name...};
      else
        return std::array<std::string_view, 0>{};
    },
    members_of<Struct>);

/// Reads such a struct if the element has exactly these members within bounds. False: use the general reader.
template <class Struct>
bool read_reals(const Field& list, std::size_t index, Struct& into) {
  constexpr auto& names = kNamesOfReals<Struct>;
  if constexpr (names.empty()) {
    return false;
  } else {
    std::array<double, names.size()> reals;
    if (!list.reals(index, names, reals)) return false;
    const double* next = reals.data();
    const auto take = [&](const auto& member) {
      into.*member.at = *next++;
      return into.*member.at >= member.least && into.*member.at <= member.most;
    };
    return std::apply([&](const auto&... each) { return (take(each) && ...); }, members_of<Struct>);
  }
}

template <class... Members>
constexpr Group<Members...> group(std::string_view name, Members... members) {
  return {name, {members...}};
}

template <class Struct>
void read_members(const Field& object, Struct& into, const icd::Rules& rules) {
  std::apply(
      [&]<class... Members>(const Members&... each) {
        static_assert((Members::kCount + ...) + kUnsent<Struct> == icd::count_of_members<Struct>(),
                      "a member of the struct is not among its members_of");
        (each.read(object, into, rules), ...);
      },
      members_of<Struct>);
  if constexpr (std::same_as<Struct, icd::Quaternion>) {
    if (const auto rotation = icd::rotation_of(into))
      into = *rotation;
    else
      object.refuse("expected a quaternion of length 1, got one too short to have a direction");
  }
}

template <class Struct>
std::size_t count_written(const Struct& from) {
  return std::apply([&](const auto&... each) { return (each.count_written(from) + ...); },
                    members_of<Struct>);
}

template <class Struct>
void write_members(CborWriter& out, const Struct& from) {
  std::apply([&](const auto&... each) { (each.write(out, from), ...); }, members_of<Struct>);
}

template <class Struct>
void write_struct(CborWriter& out, const Struct& from) {
  out.map(count_written(from));
  write_members(out, from);
}

// The ICD's messages (6), each member in the order of its listings, and ROS's further members.

/// "header": {"stamp", "frame_id"}.
struct HeaderMember {
  static constexpr std::size_t kCount = 1;
  void read(const Field& parent, auto& into, const icd::Rules& rules) const {
    into.header = read_header(parent, rules);
  }
  static std::size_t count_written(const auto& /*from*/) { return 1; }
  void write(CborWriter& out, const auto& from) const { write_header(out, from.header); }
};

/// "type" and "action". The action is read first, because it decides which members a marker needs.
struct TypeAndAction {
  static constexpr std::size_t kCount = 2;
  void read(const Field& parent, icd::Marker& into, const icd::Rules& rules) const {
    into.action = read_action(parent.member("action"));
    kType.read(parent, into, rules);
  }
  static std::size_t count_written(const icd::Marker& /*from*/) { return 2; }
  void write(CborWriter& out, const icd::Marker& from) const {
    kType.write(out, from);
    out.text("action");
    out.integer(static_cast<std::int64_t>(from.action));
  }

 private:
  static constexpr auto kType =
      named("type", &icd::Marker::type).from(0).to(icd::kLastMarkerType).needed(Presence::ToAdd);
};

template <>
inline constexpr auto members_of<icd::Point> =
    std::tuple(named("x", &icd::Point::x), named("y", &icd::Point::y), named("z", &icd::Point::z));

template <>
inline constexpr auto members_of<icd::Quaternion> =
    std::tuple(named("x", &icd::Quaternion::x), named("y", &icd::Quaternion::y),
               named("z", &icd::Quaternion::z), named("w", &icd::Quaternion::w));

template <>
inline constexpr auto members_of<icd::Pose> =
    std::tuple(named("position", &icd::Pose::position), named("orientation", &icd::Pose::orientation));

template <>
inline constexpr auto members_of<icd::Color> =
    std::tuple(named("r", &icd::Color::r).from(0).to(1), named("g", &icd::Color::g).from(0).to(1),
               named("b", &icd::Color::b).from(0).to(1), named("a", &icd::Color::a).from(0).to(1));

template <>
inline constexpr auto members_of<icd::OccupancyGrid> =  // 6.3.1
    std::tuple(HeaderMember{},
               group("info", named("resolution", &icd::OccupancyGrid::resolution),
                     named("width", &icd::OccupancyGrid::width).from(1).to(icd::kMostCellsASide),
                     named("height", &icd::OccupancyGrid::height).from(1).to(icd::kMostCellsASide),
                     named("origin", &icd::OccupancyGrid::origin)));

template <>
inline constexpr auto members_of<icd::FieldSchema> =
    std::tuple(named("name", &icd::FieldSchema::name), named("offset", &icd::FieldSchema::offset),
               named("datatype", &icd::FieldSchema::datatype).from(1).to(8),
               named("count", &icd::FieldSchema::count).from(1));

template <>
inline constexpr auto members_of<icd::PointCloud2> =  // 6.3.2
    std::tuple(HeaderMember{}, named("origin", &icd::PointCloud2::origin).needed(Presence::MayLack),
               named("fields", &icd::PointCloud2::fields).to(icd::kMostFields, " fields"),
               named("is_bigendian", &icd::PointCloud2::is_bigendian).needed(Presence::MayLack),
               named("point_step", &icd::PointCloud2::point_step).from(1).to(icd::kLargestPoint));

template <>
inline constexpr std::size_t kUnsent<icd::Marker> = 1;  // expires
template <>
inline constexpr auto members_of<icd::Marker> = std::tuple(  // 6.6
    HeaderMember{}, named("ns", &icd::Marker::ns).needed(Presence::MayLack),
    named("id", &icd::Marker::id).needed(Presence::MayLack), TypeAndAction{},
    named("pose", &icd::Marker::pose).needed(Presence::ToAdd),
    named("scale", &icd::Marker::scale).needed(Presence::ToAdd),
    named("color", &icd::Marker::color).needed(Presence::ToAdd),
    named("lifetime", &icd::Marker::lifetime).time_to(icd::kLongestLifetime).needed(Presence::MayLack),
    named("text", &icd::Marker::text).needed(Presence::MayLack),
    // ROS's further members of a Marker. Viewers ignore colors whose number differs from that of the points.
    named("frame_locked", &icd::Marker::frame_locked).needed(Presence::IfSaid),
    named("points", &icd::Marker::points).to(icd::kMostMarkerPoints).needed(Presence::IfSaid),
    named("colors", &icd::Marker::colors).to(icd::kMostMarkerPoints).needed(Presence::IfSaid),
    named("mesh_resource", &icd::Marker::mesh_resource)
        .to(icd::kLongestMeshResource, " bytes")
        .needed(Presence::IfSaid),
    named("mesh_use_embedded_materials", &icd::Marker::mesh_use_embedded_materials).needed(Presence::IfSaid));

}  // namespace adit::codec
