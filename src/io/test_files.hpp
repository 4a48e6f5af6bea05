#pragma once
/// What the readers share whose tests are a header and one file a channel beside it.

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <crashsim/trace.hpp>

namespace crashsim::io {

/// Paths of what a folder holds by the lower-case names; none when it cannot be listed.
std::map<std::string, std::string> files_in(const std::filesystem::path& folder);

/// The number that a channel file's extension is, 0 when it is none: "v10146.093" is 93.
int channel_number(const std::string& path);

/// A file's name without extension, lower-case: "v10146".
std::string stem_of(const std::string& path);

/// The compartment's channels: those with files, else those the header names. Warns where that makes a difference.
/// @param wanted the best by the header. @param present the best of those that are `usable`.
std::vector<std::size_t> choose_compartment(const std::vector<std::size_t>& wanted,
                                            const std::vector<std::size_t>& present, const std::vector<bool>& usable,
                                            TraceSet& set);

}  // namespace crashsim::io
