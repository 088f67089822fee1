#include "core/field_transfer.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace {

using namespace peclet;

TEST(FieldTransfer, KeepsEveryCellAndLeavesGhostsAlone) {
  const Layout layout({5, 3, 2});
  const Field<double> field("field", layout);
  field.fill(-7);
  std::vector<double> values(30);
  for (std::size_t n = 0; n < values.size(); ++n) values[n] = static_cast<double>(n);
  copy_from_host(values.data(), field);

  std::vector<double> found(30, -1);
  copy_to_host(field, found.data());
  EXPECT_EQ(found, values);
  const std::vector<double> memory = copy_to_host(field.array());
  EXPECT_EQ(memory[static_cast<std::size_t>(layout(4, 2, 1))], 29);
  EXPECT_EQ(memory[static_cast<std::size_t>(layout(-1, 0, 0))], -7);
  EXPECT_EQ(memory[static_cast<std::size_t>(layout(0, 3, 1))], -7);
}

}  // namespace
