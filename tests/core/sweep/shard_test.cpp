// Which points a shard has, what schedulers say of it, and what a shard file is when something went wrong.
#include "io/shard.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "support/random.h"
#include "sweep/emit_sweep.h"
#include "sweep/sweep_rows.h"

namespace cloth::test::shard_test {
namespace {

std::variant<Shard, Problem> shard(const std::string& text,
                                   const std::map<std::string, std::string>& set = {}) {
  return shard_from(text, [set](const char* name) {
    const auto found = set.find(name);
    return found == set.end() ? std::string() : found->second;
  });
}

void expect_shard(const std::string& text, const std::map<std::string, std::string>& set, Shard expected) {
  const auto found = shard(text, set);
  if (const auto* problem = std::get_if<Problem>(&found)) {
    ADD_FAILURE() << text << ": " << problem->text();
    return;
  }
  EXPECT_EQ(std::get<Shard>(found).index, expected.index) << text;
  EXPECT_EQ(std::get<Shard>(found).count, expected.count) << text;
}

TEST(Shards, TogetherHaveEveryPointOnce) {
  for (const std::int64_t count : {1, 2, 7, 40})
    for (std::int64_t point = 0; point < 50; ++point) {
      int owners = 0;
      for (std::int64_t index = 1; index <= count; ++index) owners += Shard{index, count}.has(point);
      EXPECT_EQ(owners, 1);
    }
}

TEST(Shards, MayShareAPointExactlyWhereThereIsOne) {
  for (std::int64_t m = 1; m <= 8; ++m)
    for (std::int64_t n = 1; n <= 8; ++n)
      for (std::int64_t i = 1; i <= m; ++i)
        for (std::int64_t j = 1; j <= n; ++j) {
          bool shared = false;
          for (std::int64_t point = 0; point < m * n; ++point)
            shared = shared || (Shard{i, m}.has(point) && Shard{j, n}.has(point));
          EXPECT_EQ(may_share_points({i, m}, {j, n}), shared) << i << "/" << m << " " << j << "/" << n;
        }
}

TEST(Shards, AreSaidOrTakenFromTheScheduler) {
  expect_shard("17/400", {}, {17, 400});
  expect_shard("auto/400", {{"SLURM_ARRAY_TASK_ID", "3"}}, {3, 400});
  expect_shard("auto+1000/2500", {{"SLURM_ARRAY_TASK_ID", "3"}}, {1003, 2500});
  expect_shard("auto/9", {{"PBS_ARRAY_INDEX", "9"}}, {9, 9});
  expect_shard("auto/9", {{"PBS_ARRAYID", "4"}}, {4, 9});
  expect_shard("auto/9", {{"SGE_TASK_ID", "2"}}, {2, 9});
  expect_shard("auto/9", {{"LSB_JOBINDEX", "2"}}, {2, 9});
  expect_shard("auto/9", {{"PARALLEL_SEQ", "5"}}, {5, 9});
  std::map<std::string, std::string> slurm{{"SLURM_ARRAY_TASK_ID", "0"},
                                           {"SLURM_ARRAY_TASK_MIN", "0"},
                                           {"SLURM_ARRAY_TASK_MAX", "9"},
                                           {"SLURM_ARRAY_TASK_COUNT", "10"},
                                           {"SLURM_ARRAY_TASK_STEP", "1"}};
  expect_shard("auto", slurm, {1, 10});
  expect_shard(
      "auto",
      {{"SGE_TASK_ID", "3"}, {"SGE_TASK_FIRST", "1"}, {"SGE_TASK_LAST", "8"}, {"SGE_TASK_STEPSIZE", "1"}},
      {3, 8});
  expect_shard("auto", {{"LSB_JOBINDEX", "3"}, {"LSB_JOBINDEX_END", "8"}, {"LSB_JOBINDEX_STEP", "1"}},
               {3, 8});
}

TEST(Shards, ThatAreNotKnownForSureAreRefused) {
  for (const char* text : {"", "3", "0/4", "5/4", "1/0", "a/4", "1/4x", "auto-1/4", "auto+x/4", "-1/4"})
    EXPECT_TRUE(std::holds_alternative<Problem>(shard(text, {{"SLURM_ARRAY_TASK_ID", "1"}}))) << text;
  EXPECT_TRUE(std::holds_alternative<Problem>(shard("auto/4"))) << "no scheduler";
  EXPECT_TRUE(std::holds_alternative<Problem>(shard("auto/4", {{"SGE_TASK_ID", "undefined"}})));
  EXPECT_TRUE(std::holds_alternative<Problem>(shard("auto/4", {{"LSB_JOBINDEX", "0"}})));
  EXPECT_TRUE(std::holds_alternative<Problem>(shard("auto", {{"PBS_ARRAY_INDEX", "3"}}))) << "number unknown";
  // --array=3,7-9: its largest index is not how many shards the sweep has.
  EXPECT_TRUE(std::holds_alternative<Problem>(shard("auto", {{"SLURM_ARRAY_TASK_ID", "8"},
                                                             {"SLURM_ARRAY_TASK_MIN", "3"},
                                                             {"SLURM_ARRAY_TASK_MAX", "9"},
                                                             {"SLURM_ARRAY_TASK_COUNT", "4"}})));
}

TEST(ShardFileNames, HaveTheirShard) {
  for (const Shard& one : {Shard{1, 1}, Shard{17, 400}}) {
    const auto back = shard_of_file(shard_file_name(one, "node.7", 1234, 3));
    ASSERT_TRUE(back);
    EXPECT_EQ(*back, one);
  }
  for (const char* other :
       {"", "1-of-2", "1-of-2.jsonl.part", "5-of-2.a.jsonl", "x-of-2.a.jsonl", "notes.txt"})
    EXPECT_FALSE(shard_of_file(other)) << other;
}

PointRow any_row(Random& random) {
  PointRow row{.point = random.integer(0, 1000), .scene = "0123456789abcdef"};
  row.status = static_cast<PointStatus>(random.integer(0, point_statuses - 1));
  if (random.coin()) row.cause = "at \"t\" = 3,\n\tand \x01 more";
  row.outputs = {random.normal(1e300), random.normal(1e-300), std::nan(""), infinity, -infinity, 0.1, -0.0};
  row.steps = random.integer(0, 1'000'000);
  row.wall = random.uniform(0, 1);
  return row;
}

TEST(ShardFiles, ReadBackToTheSameBits) {
  Random random;
  std::vector<PointRow> rows;
  std::string text = line_of(Attempt{.plan = "p",
                                     .version = "v",
                                     .instruction_set = "avx2",
                                     .processor = "any",
                                     .host = "here",
                                     .shard = {3, 7}}) +
                     "\n";
  for (int k = 0; k < 100; ++k) text += line_of(rows.emplace_back(any_row(random))) + "\n";
  const ShardFile file = parse_shard_file("a", text, 7);
  EXPECT_EQ(file.damaged, 0);
  EXPECT_EQ(file.attempt.shard, (Shard{3, 7}));
  EXPECT_EQ(file.attempt.maker(), "here (any, avx2)");
  ASSERT_EQ(file.rows.size(), rows.size());
  for (std::size_t k = 0; k < rows.size(); ++k) {
    EXPECT_EQ(file.rows[k].point, rows[k].point);
    EXPECT_EQ(file.rows[k].status, rows[k].status);
    EXPECT_EQ(file.rows[k].cause, rows[k].cause);
    EXPECT_EQ(file.rows[k].wall, rows[k].wall);
    EXPECT_TRUE(agree(file.rows[k], rows[k]));
  }
}

TEST(ShardFiles, CutAnywhereHaveTheirWholeLinesAndNoOthers) {
  Random random;
  std::string text = line_of(Attempt{.plan = "p"}) + "\n";
  std::vector<std::size_t> ends{text.size()};
  for (int k = 0; k < 5; ++k) {
    text += line_of(any_row(random)) + "\n";
    ends.push_back(text.size());
  }
  for (std::size_t size = 0; size <= text.size(); ++size) {
    const ShardFile file = parse_shard_file("a", text.substr(0, size), 7);
    const auto whole = std::count_if(ends.begin(), ends.end(), [&](std::size_t end) { return end <= size; });
    EXPECT_EQ(std::ssize(file.rows), std::max<std::ptrdiff_t>(0, whole - 1)) << size;
    EXPECT_EQ(file.damaged, 0) << size;
  }
}

TEST(ShardFiles, LeaveOutWhatALossOfPowerMadeOfALine) {
  Random random;
  const std::string first = line_of(Attempt{.plan = "p"}) + "\n", row = line_of(any_row(random)) + "\n";
  const ShardFile file = parse_shard_file("a", first + std::string(40, '\0') + "\n" + row + "{}\n", 7);
  EXPECT_EQ(file.rows.size(), 1u);
  EXPECT_EQ(file.damaged, 2);
  EXPECT_EQ(parse_shard_file("a", first + row, 6).rows.size(), 0u) << "of other outputs";
  EXPECT_EQ(parse_shard_file("a", row + row, 7).rows.size(), 0u) << "nobody says who wrote it";
}

TEST(Rows, AgreeUnlessABitThatIsNotOfTheMachineDiffers) {
  PointRow row{.point = 1, .scene = "s", .outputs = {1.0, std::nan("")}, .steps = 7, .wall = 1};
  PointRow other = row;
  other.wall = 2;
  EXPECT_TRUE(agree(row, other));
  other.outputs[0] = std::nextafter(1.0, 2.0);
  EXPECT_FALSE(agree(row, other));
  other = row;
  other.status = PointStatus::diverged;
  EXPECT_FALSE(agree(row, other));
  other.status = PointStatus::limit_wall;
  EXPECT_TRUE(agree(row, other)) << "a slower machine";
  other.scene = "t";
  EXPECT_FALSE(agree(row, other));
}

TEST(Packing, FillsATaskButHasNoMoreShardsThanPoints) {
  EXPECT_EQ(packed_shards(1000, 1, 1, 600), 2);
  EXPECT_EQ(packed_shards(1000, 60, 1, 600), 100);
  EXPECT_EQ(packed_shards(1000, 60, 4, 600), 25);
  EXPECT_EQ(packed_shards(1000, 6000, 1, 600), 1000);
  EXPECT_EQ(packed_shards(10, 1e-9, 1, 600), 1);
}

}  // namespace
}  // namespace cloth::test::shard_test
