#include <charconv>

#include <fmt/format.h>

#include <crashsim/batch_options.hpp>
#include <crashsim/error.hpp>

namespace crashsim {
namespace {

/// A whole number that is all of a text; 0 when it is not.
int whole(std::string_view text) {
  int number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc() && end == text.data() + text.size() ? number : 0;
}

}  // namespace

BatchShard parse_shard(const std::string& text) {
  constexpr int kMostShards = 1'000'000;
  const std::size_t slash = std::min(text.find('/'), text.size());
  const std::string_view all = text;
  const BatchShard shard{whole(all.substr(0, slash)), whole(all.substr(std::min(slash + 1, text.size())))};
  if (shard.index < 1 || shard.count < shard.index || shard.count > kMostShards)
    throw InvalidInput(
        fmt::format("shard '{}': must be I/N with whole numbers 1 <= I <= N <= {}, as in 2/8", text, kMostShards));
  return shard;
}

}  // namespace crashsim
