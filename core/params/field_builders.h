// Functions that make the declaration of a parameter from a member pointer and a ParameterInfo.
#pragma once

#include <concepts>
#include <type_traits>
#include <utility>

#include "params/parameter.h"

namespace cloth {

/// The same declaration for values greater than 0.
inline ParameterInfo positive(ParameterInfo info) {
  info.minimum = 0;
  info.minimum_excluded = true;
  return info;
}

/// A member of type double, Vec3, std::string or Words; its type decides the kind: a std::string is a choice
/// where `info` has choices, else a text.
template <class Owner, class Value>
Field<Owner> field(Value Owner::*member, ParameterInfo info) {
  if constexpr (std::is_same_v<Value, Vec3>) info.kind = Kind::vector;
  if constexpr (std::is_same_v<Value, Words>) info.kind = Kind::words;
  if constexpr (std::is_same_v<Value, std::string>)
    info.kind = info.choices.empty() ? Kind::text : Kind::choice;
  return {with_physical_bound(std::move(info)),
          [member](const Owner& owner) { return ParameterValue(owner.*member); },
          [member](Owner& owner, const ParameterValue& value) { owner.*member = std::get<Value>(value); }};
}

/// A whole number.
template <class Owner, std::integral Value>
Field<Owner> field(Value Owner::*member, ParameterInfo info) {
  info.kind = Kind::integer;
  return {with_physical_bound(std::move(info)),
          [member](const Owner& owner) { return ParameterValue(std::int64_t{owner.*member}); },
          [member](Owner& owner, const ParameterValue& value) {
            owner.*member = static_cast<Value>(std::get<std::int64_t>(value));
          }};
}

/// A number whose absence is the word "auto".
template <class Owner>
Field<Owner> number_or_auto(std::optional<double> Owner::*member, ParameterInfo info) {
  info.auto_allowed = true;
  return {with_physical_bound(std::move(info)),
          [member](const Owner& owner) -> ParameterValue {
            return owner.*member ? ParameterValue(*(owner.*member)) : ParameterValue(std::string("auto"));
          },
          [member](Owner& owner, const ParameterValue& value) {
            if (const double* number = std::get_if<double>(&value))
              owner.*member = *number;
            else
              owner.*member = std::nullopt;
          }};
}

/// An optional value at the root of a scene; absent: that force does not exist. `get` needs it to be present.
template <class Owner, class Value>
Field<Owner> optional_field(std::optional<Value> Owner::*member, ParameterInfo info) {
  if (std::is_same_v<Value, Vec3>) info.kind = Kind::vector;
  return {with_physical_bound(std::move(info)),
          [member](const Owner& owner) { return ParameterValue((owner.*member).value()); },
          [member](Owner& owner, const ParameterValue& value) { owner.*member = std::get<Value>(value); }};
}

}  // namespace cloth
