#include "server/durable/upload_table.h"

#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "tests/support/temporary_folder.h"

namespace bccskel::server {
namespace {

class UploadTableTest : public testing::Test {
 protected:
  static UploadRow Row(const std::string& name, const std::string& file = {},
                       const std::string& tenant = "clinic") {
    UploadRow row;
    row.tenant = tenant;
    row.name = name;
    row.file = file;
    return row;
  }
  UploadTable::Session Open(const UploadRow& row) const {
    auto file = UploadFile::Open(folder_ / "file");
    EXPECT_TRUE(file.ok()) << file.status();
    return std::make_shared<UploadSession>(row, *std::move(file), Time());
  }

  const test::TemporaryFolder folder_;
  UploadTable table_;
};

TEST_F(UploadTableTest, FindsUploadsByTenantAndName) {
  const auto session = Open(Row("uploads/1"));
  table_.Add(session);
  EXPECT_EQ(table_.Find("clinic", "uploads/1"), session);
  EXPECT_EQ(table_.Find("lab", "uploads/1"), nullptr);
  EXPECT_EQ(table_.Find("clinic", "uploads/2"), nullptr);
  EXPECT_EQ(table_.size(), 1u);
}

TEST_F(UploadTableTest, OneOpensAnUploadAtATime) {
  const UploadRow row = Row("uploads/1");
  EXPECT_TRUE(table_.BeginOpening(row));
  EXPECT_FALSE(table_.BeginOpening(row));
  EXPECT_TRUE(table_.BeginOpening(Row("uploads/1", {}, "lab"))) << "another one";
  table_.EndOpening(row);
  EXPECT_TRUE(table_.BeginOpening(row)) << "it could not be opened";
  table_.Add(Open(row));
  EXPECT_FALSE(table_.BeginOpening(row)) << "it is there";
  table_.Remove(row);
  EXPECT_EQ(table_.Find("clinic", "uploads/1"), nullptr);
  EXPECT_TRUE(table_.BeginOpening(row));
}

TEST_F(UploadTableTest, RemovesASessionOnlyWhileItsUploadGoesOnInIt) {
  const auto old = Open(Row("uploads/1", "old")), now = Open(Row("uploads/1", "new"));
  table_.Add(old);
  table_.Add(now);
  table_.Remove(old);
  table_.EndOpening(now->row());
  EXPECT_EQ(table_.Find("clinic", "uploads/1"), now) << "it goes on in another file";
  table_.Remove(now);
  EXPECT_EQ(table_.Find("clinic", "uploads/1"), nullptr);
}

}  // namespace
}  // namespace bccskel::server
