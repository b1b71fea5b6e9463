// SPDX-License-Identifier: BSD-3-Clause
// Where the value of a key lives in the program.
// tested: tests/base/scene/fragment_test.cpp
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <type_traits>
#include <typeinfo>
#include <utility>
#include <variant>
#include <vector>

namespace isostat
{
struct PercentPair
{
  double *low, *high;
};
using SizeCurve = std::vector<std::pair<double, double>>;

/// A place whose values 0, 1, ... are the words of the key in their order.
struct EnumField
{
  std::function<std::size_t()> get;
  std::function<void(std::size_t word)> set;
};

/// Form of a value in the file.
enum class Kind
{
  quantity,      ///< text with a unit, "10 mm"
  number,        ///< plain number without unit
  integer,       ///< plain whole number >= 0
  boolean,       ///< true or false
  choice,        ///< one of a list of words
  text,          ///< any text in quotes
  table,         ///< { ... }; its being there may switch physics on
  quantity_list, ///< ["1 m", "2 m"]
  percent_pair,  ///< [low, high], percent
  size_curve     ///< [["0.0631 mm", 1.53], ...], diameter and percent finer
};

/// monostate: nowhere (a table that only holds others).
using Field = std::variant<std::monostate, double *, std::optional<double> *, std::uint64_t *, unsigned *, bool *,
                           std::string *, EnumField, std::vector<double> *, PercentPair, SizeCurve *>;

/// A struct of any type, so that one machinery reads every kind of scene.
class StructRef
{
public:
  /// Constant or not: whoever holds the reference knows whether it may write.
  template <class Struct>
  requires(!std::is_same_v<Struct, StructRef>) StructRef(const Struct &place)
      : place_(const_cast<Struct *>(&place)), type_(&typeid(Struct))
  {}

  /// Of the type that it was made from. A class with a KeyRoot, the base that lists of its kind hold, is found there.
  /// @throws std::bad_cast  it is of another type
  template <class Struct>
  Struct &as() const
  {
    if constexpr (requires { typename Struct::KeyRoot; })
      if constexpr (!std::is_same_v<Struct, typename Struct::KeyRoot>)
        return dynamic_cast<Struct &>(as<typename Struct::KeyRoot>());
    if (*type_ != typeid(Struct))
      throw std::bad_cast();
    return *static_cast<Struct *>(place_);
  }

private:
  void *place_;
  const std::type_info *type_;
};

/// A function of a struct, made from a lambda (Struct &) without captures; the type is forgotten.
template <class Result>
class Access
{
public:
  constexpr Access() = default;
  template <class Lambda>
  requires std::is_empty_v<Lambda>
  constexpr Access(Lambda) : Access(&Lambda::operator()) {}

  Result operator()(StructRef place) const { return call_(place); }
  constexpr explicit operator bool() const { return call_ != nullptr; }

private:
  template <class Lambda, class Returned, class Struct>
  constexpr Access(Returned (Lambda::*)(Struct &) const)
      : call_([](StructRef place) -> Result { return Lambda{}(place.as<Struct>()); })
  {}

  Result (*call_)(StructRef) = nullptr;
};

/// Where the struct of a fragment (base/scene/fragment.hpp) lies in a larger one: (Whole &) -> Part &.
using PartAccess = Access<StructRef>;

/// How a key finds its field, (Struct &) -> Field: member<&Struct::x> below, or a lambda.
class FieldAccess : public Access<Field>
{
public:
  constexpr FieldAccess() = default;
  template <class Lambda>
  requires std::is_empty_v<Lambda>
  constexpr FieldAccess(Lambda access) : Access<Field>(access), kind_(kind_of(&Lambda::operator())) {}

  /// What the type of the field says of the form in the file: `number` may be a quantity.
  constexpr Kind kind() const { return kind_; }

  Field operator()(StructRef place) const
  {
    if (!*this)
      return {};
    for (std::size_t i = n_parts_; i-- > 0;)
      place = parts_[i](place);
    return Access<Field>::operator()(place);
  }

  /// The same field of a struct that lies within a larger one.   @pre at most three levels
  constexpr FieldAccess within(PartAccess part) const
  {
    FieldAccess access = *this;
    access.parts_[access.n_parts_++] = part;
    return access;
  }

private:
  template <class Lambda, class Returned, class Struct>
  static constexpr Kind kind_of(Returned (Lambda::*)(Struct &) const)
  {
    constexpr auto is = []<class... Types>(std::type_identity<Types>...) {
      return (std::is_same_v<Returned, Types> || ...);
    };
    if (is(std::type_identity<std::uint64_t *>(), std::type_identity<unsigned *>()))
      return Kind::integer;
    return is(std::type_identity<bool *>())                  ? Kind::boolean
           : is(std::type_identity<std::string *>())         ? Kind::text
           : is(std::type_identity<EnumField>())             ? Kind::choice
           : is(std::type_identity<std::vector<double> *>()) ? Kind::quantity_list
           : is(std::type_identity<PercentPair>())           ? Kind::percent_pair
           : is(std::type_identity<SizeCurve *>())           ? Kind::size_curve
                                                             : Kind::number;
  }

  std::array<PartAccess, 3> parts_ = {}; ///< from the innermost outwards
  std::size_t n_parts_ = 0;
  Kind kind_ = Kind::number;
};

namespace detail
{
template <auto member>
struct Member;
template <class Struct_, class Value_, Value_ Struct_::*member>
struct Member<member>
{
  using Struct = Struct_;
  using Value = Value_;
};

/// A member of a struct, or a member of its member.
template <auto... members, class Struct>
auto &member_in(Struct &place)
{
  return (place.*....*members);
}

template <class Value>
auto field_of(Value &place)
{
  if constexpr (std::is_enum_v<Value>)
    return EnumField{[&place] { return static_cast<std::size_t>(place); },
                     [&place](std::size_t word) { place = static_cast<Value>(word); }};
  else
    return &place;
}
} // namespace detail

/// A member of a struct, or a member of its member: member<&Scene::grading, &GradingSpec::seed>.
/// member_of<Struct, ...>: one that the struct has from its base.
template <class Struct, auto... members>
inline constexpr FieldAccess member_of{
    [](Struct &place) { return detail::field_of(detail::member_in<members...>(place)); }};
template <auto first, auto... others>
inline constexpr FieldAccess member = member_of<typename detail::Member<first>::Struct, first, others...>;

/// How the entries of an array of tables are reached in a scene.
struct ItemAccess
{
  Access<std::size_t> count = {};
  StructRef (*at)(StructRef scene, std::size_t i) = nullptr; ///< behind the last: one more, with its defaults

  constexpr explicit operator bool() const { return at != nullptr; }
};

/// items_of<&Scene::stages>: of a vector in the scene.
template <auto member>
inline constexpr ItemAccess items_of{
    [](typename detail::Member<member>::Struct &scene) { return (scene.*member).size(); },
    [](StructRef scene, std::size_t i) -> StructRef {
      auto &items = scene.as<typename detail::Member<member>::Struct>().*member;
      return i < items.size() ? items[i] : items.emplace_back();
    }};
} // namespace isostat
