#include <crashsim/messages.hpp>

namespace crashsim {

std::string shortened(std::string_view text, std::size_t longest) {
  constexpr std::string_view kGap = " .. ";
  if (text.size() <= longest) return std::string(text);
  const std::size_t half = (longest - kGap.size()) / 2;
  return std::string(text.substr(0, half)) + std::string(kGap) + std::string(text.substr(text.size() - half));
}

}  // namespace crashsim
