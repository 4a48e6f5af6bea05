#pragma once
/// Whose the values of a binout's variables are: nodes, parts, contacts, walls.

#include <map>
#include <string>
#include <unordered_map>
#include <vector>

#include "io/lsdyna_binout_index.hpp"

namespace crashsim::io {

struct BinoutEntity {
  std::string name;   ///< Its number; "2 slave" for a side of a contact; "#3" when the file has no ids for it.
  std::string title;  ///< "" when it has none.
};

/// The entities of one database.
class BinoutEntities {
 public:
  BinoutEntities(const BinoutBranch& branch, const BinoutIndex& index);

  /// The entities of a variable's values, in their order; none when it belongs to the whole model.
  const std::vector<BinoutEntity>* of(const BinoutSeries& series);
  /// What a careful reader should know of them.
  [[nodiscard]] std::vector<std::string> warnings() const;

 private:
  [[nodiscard]] std::string key_of(const BinoutSeries& series) const;
  std::vector<BinoutEntity> numbered(const std::vector<double>& ids);
  const std::vector<BinoutEntity>* walls(std::size_t count);
  void read_titles();
  void add_sides(std::vector<BinoutEntity>& entities) const;

  const BinoutBranch& branch_;
  const BinoutIndex& index_;
  std::unordered_map<std::string, std::string> titles_;      // by number
  std::map<std::string, std::vector<BinoutEntity>> by_key_;  // by the list of ids that names them
  std::size_t repeated_ = 0;
  std::vector<std::string> without_ids_;
};

}  // namespace crashsim::io
