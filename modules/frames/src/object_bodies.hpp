// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <string>

namespace colonnade {

class ObjectWalker;

/// A class or version whose format is not written down in object_bodies.cpp.
struct UnknownFormat {};

/// Walks over what stands between header and end flag of an object of this version.
using ObjectBody = std::function<void(ObjectWalker&, std::uint8_t version)>;

/// The body of a class (name without namespaces), or null when its format is not known here.
const ObjectBody* bodyOf(const std::string& short_name);

}  // namespace colonnade
