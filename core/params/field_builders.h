// How a declaration is written down: a member pointer and its facts.
#pragma once

#include <type_traits>
#include <utility>

#include "params/parameter.h"

namespace cloth {

template <class Owner, class Value>
Field<Owner> plain_field(Value Owner::*member, ParameterInfo info) {
  return {with_physical_bound(std::move(info)),
          [member](const Owner& owner) { return ParameterValue(owner.*member); },
          [member](Owner& owner, const ParameterValue& value) { owner.*member = std::get<Value>(value); }};
}

template <class Owner>
Field<Owner> number(double Owner::*member, ParameterInfo info) {
  return plain_field(member, std::move(info));
}

template <class Owner>
Field<Owner> vector(Vec3 Owner::*member, ParameterInfo info) {
  info.kind = Kind::vector;
  return plain_field(member, std::move(info));
}

template <class Owner>
Field<Owner> integer(std::int64_t Owner::*member, ParameterInfo info) {
  info.kind = Kind::integer;
  return plain_field(member, std::move(info));
}

template <class Owner>
Field<Owner> integer(int Owner::*member, ParameterInfo info) {
  info.kind = Kind::integer;
  return {std::move(info),
          [member](const Owner& owner) { return ParameterValue(std::int64_t{owner.*member}); },
          [member](Owner& owner, const ParameterValue& value) {
            owner.*member = static_cast<int>(std::get<std::int64_t>(value));
          }};
}

template <class Owner>
Field<Owner> choice(std::string Owner::*member, ParameterInfo info) {
  info.kind = Kind::choice;
  return plain_field(member, std::move(info));
}

template <class Owner>
Field<Owner> text(std::string Owner::*member, ParameterInfo info) {
  info.kind = Kind::text;
  return plain_field(member, std::move(info));
}

template <class Owner>
Field<Owner> words(Words Owner::*member, ParameterInfo info) {
  info.kind = Kind::words;
  return plain_field(member, std::move(info));
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

/// A root value whose absence is absent physics. `get` needs it to be present.
template <class Owner, class Value>
Field<Owner> optional_field(std::optional<Value> Owner::*member, ParameterInfo info) {
  if (std::is_same_v<Value, Vec3>) info.kind = Kind::vector;
  return {with_physical_bound(std::move(info)),
          [member](const Owner& owner) { return ParameterValue((owner.*member).value()); },
          [member](Owner& owner, const ParameterValue& value) { owner.*member = std::get<Value>(value); }};
}

}  // namespace cloth
