// Saved tables: an engine saves and loads them, and our programs cache them on disk.
#include <unistd.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <memory>
#include <optional>
#include <random>

#include "files/file_cache.hpp"
#include "models/precomputed.hpp"
#include "table_fixture.hpp"
#include "table_rays.hpp"
#include "tables/make_ready.hpp"
#include "tables/pipeline_store.hpp"
#include "tyndall/version.hpp"

namespace tyndall {
namespace {

TEST_F(SavedTablesTest, LoadedTablesEqualSavedTables) {
  Effect built = make(small_tables(), true);
  EXPECT_EQ(built.table_bytes(), 8U * (3U * 6 * 16 * 12 * 4 + 2U * 64 * 256));
  const std::vector<std::byte> bytes = save(built);
  EXPECT_EQ(save(built, 4096), bytes);
  // Tables are stored in the documented order.
  TableBuilder builder;
  ASSERT_OK(create(builder, false, small_tables()));
  TableBuilderTest::build(builder, UINT32_MAX);
  std::vector<std::byte> in_order;
  for (std::uint32_t i = 0; i < kTableCount; ++i) {
    const std::vector<std::byte> table = TableBuilderTest::bytes(builder, static_cast<TableId>(i));
    in_order.insert(in_order.end(), table.begin(), table.end());
  }
  EXPECT_EQ(bytes, in_order);

  Effect loaded = make(small_tables(), false);
  EXPECT_EQ(loaded.table_key(), built.table_key());
  ASSERT_OK(load(loaded, bytes, 64));
  EXPECT_TRUE(loaded.precompute_progress().complete());
  EXPECT_EQ(save(loaded), bytes);
  // After loading, nothing remains to be built. Loading ends a build in progress.
  std::vector<std::byte> noise(bytes.size(), std::byte{1});
  ASSERT_OK(load(loaded, noise));
  EXPECT_EQ(save(loaded), bytes);
  Effect begun = make(small_tables(), false);
  build(begun, 7);
  ASSERT_FALSE(begun.precompute_progress().complete());
  ASSERT_OK(load(begun, bytes));
  EXPECT_TRUE(begun.precompute_progress().complete());
  EXPECT_EQ(save(begun), bytes);

  // A later change rebuilds only the stale tables.
  const std::uint32_t whole = built.precompute_progress().total;
  Params params = small_tables();
  params.planet.ground_albedo = Vec3(0.5F);
  ASSERT_OK(loaded.set_params(params));
  EXPECT_FALSE(loaded.precompute_progress().complete());
  EXPECT_LT(loaded.precompute_progress().total, whole);
  build(loaded);
  Effect direct = make(params, true);
  EXPECT_NE(save(direct), bytes);
  EXPECT_EQ(save(loaded), save(direct));
  // The saved tables can also be loaded into tables that are in use.
  ASSERT_OK(loaded.set_params(small_tables()));
  ASSERT_OK(load(loaded, bytes));
  EXPECT_EQ(save(loaded), bytes);
}

TEST_F(SavedTablesTest, UnfinishedTablesAreNotSaved) {
  Effect effect = make(small_tables(), false);
  const gpu::Buffer to = buffer(effect.table_bytes() + 8);
  const auto refused = [&](VkBuffer buffer, VkDeviceSize offset) {
    Result<void> result;
    EXPECT_OK(host().run([&](VkCommandBuffer cmd) -> Result<void> {
      result = effect.record_save_tables(cmd, buffer, offset);
      return {};
    }));
    EXPECT_TRUE(result.ok() || result.error().code == ErrorCode::invalid_argument);
    return !result.ok();
  };
  EXPECT_TRUE(refused(to.buffer.get(), 0));
  build(effect, effect.precompute_progress().total - 1);
  EXPECT_TRUE(refused(to.buffer.get(), 0));
  build(effect);
  EXPECT_FALSE(refused(to.buffer.get(), 8));
  EXPECT_TRUE(refused(to.buffer.get(), 4));
  EXPECT_TRUE(refused(VK_NULL_HANDLE, 0));
  // The old tables are complete, but do not match the parameters.
  Params other = small_tables();
  other.atmosphere.aerosol_density = 3.0F;
  ASSERT_OK(effect.set_params(other));
  EXPECT_TRUE(refused(to.buffer.get(), 0));
  EXPECT_FALSE(load(effect, std::vector<std::byte>(8), 4).ok());
}

TEST_F(SavedTablesTest, KeysDifferWhereTablesDiffer) {
  Effect effect = make(small_tables(), false);
  const auto key_of = [&](const Params& params) {
    EXPECT_OK(effect.set_params(params));
    return effect.table_key();
  };
  const std::string key = effect.table_key();
  for (const char c : key) EXPECT_TRUE(c == '\n' || (c >= ' ' && c <= '~'));
  EXPECT_NE(key.find(host().device_name()), std::string::npos);
  for (const ParamInfo& row : param_table()) {
    if (row.type == ParamType::enumeration && row.choices.find('|') == std::string_view::npos) continue;
    Params params = small_tables();
    // Custom coefficients matter only if they are in use.
    params.atmosphere.custom_coefficients =
        row.name == "rayleigh_scattering" || row.name == "mie_scattering" || row.name == "mie_absorption";
    if (row.name == "droplet_diameter_um") params.atmosphere.mie_phase = MiePhase::draine;
    const std::string before = key_of(params);
    auto* const at = reinterpret_cast<char*>(&params) + row.offset;
    std::uint32_t bits = 0;
    std::memcpy(&bits, at, sizeof bits);
    const bool real = row.type == ParamType::float32 || row.type == ParamType::vec3;
    bits = row.type == ParamType::flag || row.type == ParamType::enumeration ? 1 - bits : bits + (real ? 256 : 2);
    // A value of 0, which often means that the parameter is not set, becomes one that matters.
    if (real && std::bit_cast<float>(bits - 256) == 0.0F)
      bits = std::bit_cast<std::uint32_t>(static_cast<float>(0.01 * row.max));
    // A value at the maximum of its range is decreased.
    if (real && double{std::bit_cast<float>(bits)} > row.max) bits -= 512;
    if (row.type == ParamType::enumeration && bits > 1) bits = 1;
    if (row.name == "downscale") bits = 2;  // 1, 2 and 4 are allowed
    std::memcpy(at, &bits, sizeof bits);
    EXPECT_EQ(key_of(params) != before, row.affects == Affects::Tables || row.affects == Affects::Everything)
        << row.name;
  }
}

// Returns parameters without the higher orders, which take most of the time.
Params quick_tables() {
  Params params = small_tables();
  params.tables.orders = 1;
  return params;
}

// Uses the cache in the same way as our programs.
class CachedTablesTest : public SavedTablesTest {
 protected:
  void SetUp() override {
    SavedTablesTest::SetUp();
    std::string name = (std::filesystem::temp_directory_path() / "tyndall-tables-XXXXXX").string();
    ASSERT_NE(::mkdtemp(name.data()), nullptr);
    directory_ = name;
    how_.cache.place = (directory_ / "cache").string();
  }
  void TearDown() override {
    std::filesystem::remove_all(directory_);
    SavedTablesTest::TearDown();
  }
  tables::Report ready(Effect& effect) {
    Result<tables::Report> report = tables::make_ready(host(), effect, how_);
    EXPECT_OK(report);
    EXPECT_TRUE(effect.precompute_progress().complete());
    return report ? std::move(report).value() : tables::Report();
  }
  // Prepares the tables of a new effect.
  tables::Report ready(const Params& params = quick_tables()) {
    Effect effect = make(params, false);
    tables::Report report = ready(effect);
    bytes_ = save(effect);
    return report;
  }
  [[nodiscard]] std::vector<std::filesystem::path> files() const {
    std::vector<std::filesystem::path> out;
    std::error_code missing;
    for (const auto& entry : std::filesystem::directory_iterator(directory_ / "cache", missing))
      out.push_back(entry.path());
    return out;
  }

  std::filesystem::path directory_;
  tables::MakeReady how_;
  std::vector<std::byte> bytes_;
};

TEST_F(CachedTablesTest, AreBuiltOnceAndFoundAfterwards) {
  std::uint32_t calls = 0;
  how_.progress = [&](Progress) { ++calls; };
  tables::Report report = ready();
  const std::vector<std::byte> built = bytes_;
  EXPECT_EQ(report.origin, tables::Origin::build);
  EXPECT_TRUE(report.notes.empty());
  EXPECT_GT(calls, 2U);
  ASSERT_EQ(files().size(), 1U);
  calls = 0;
  report = ready();
  EXPECT_EQ(report.origin, tables::Origin::cache);
  EXPECT_GT(report.milliseconds, 0.0);
  EXPECT_EQ(calls, 0U);
  EXPECT_EQ(bytes_, built);

  // The cached tables are used if they do not depend on a changed parameter, and rebuilt otherwise.
  Params params = quick_tables();
  params.scattering.scale = 2.0F;
  EXPECT_EQ(ready(params).origin, tables::Origin::cache);
  params.atmosphere.mie_g = 0.7F;
  EXPECT_EQ(ready(params).origin, tables::Origin::build);
  EXPECT_EQ(ready(params).origin, tables::Origin::cache);
  EXPECT_EQ(files().size(), 2U);
  Effect effect = make(params, false);
  EXPECT_EQ(ready(effect).origin, tables::Origin::cache);
  EXPECT_EQ(ready(effect).origin, tables::Origin::unchanged);
  ASSERT_OK(effect.set_params(quick_tables()));
  EXPECT_EQ(ready(effect).origin, tables::Origin::cache);
  EXPECT_EQ(save(effect), built);

  how_.rebuild = true;
  EXPECT_EQ(ready().origin, tables::Origin::build);
  EXPECT_EQ(bytes_, built);
  how_ = {};
  EXPECT_EQ(ready().origin, tables::Origin::build);
  EXPECT_EQ(files().size(), 2U);
}

TEST_F(CachedTablesTest, ProbesReadTheSameFromCachedTables) {
  std::vector<RayQuery> queries;
  for (const RayQuery& q : random_rays(5, 50, -6.0, 90.0)) {
    queries.push_back(q);
    queries.back().sky_irradiance = false;
    queries.push_back(q);
    queries.back().sky_irradiance = true;
  }
  std::vector<std::vector<models::Answer>> answers;
  for (const tables::Origin origin : {tables::Origin::build, tables::Origin::cache}) {
    Result<models::PrecomputedModel> model = models::PrecomputedModel::create(host(), quick_tables(), how_);
    ASSERT_OK(model);
    EXPECT_EQ(model.value().origin().origin, origin);
    Result<std::vector<models::Answer>> found = model.value().answer(queries);
    ASSERT_OK(found);
    answers.push_back(std::move(found).value());
  }
  for (std::size_t i = 0; i < queries.size(); ++i) {
    EXPECT_EQ(answers[0][i].radiance, answers[1][i].radiance) << i;
    EXPECT_EQ(answers[0][i].transmittance, answers[1][i].transmittance) << i;
  }
}

TEST_F(CachedTablesTest, DamagedFilesAreReportedOnceAndRebuilt) {
  ready();
  const std::vector<std::byte> built = bytes_;
  ASSERT_EQ(files().size(), 1U);
  const std::filesystem::path file = files()[0];
  std::string good;
  {
    std::ifstream in(file, std::ios::binary);
    good.assign(std::istreambuf_iterator<char>(in), {});
  }
  const auto expect_rebuilt = [&](const std::string& contents, const std::string& why) {
    std::ofstream(file, std::ios::binary) << contents;
    const tables::Report report = ready();
    EXPECT_EQ(report.origin, tables::Origin::build);
    ASSERT_EQ(report.notes.size(), 1U) << why;
    EXPECT_EQ(report.notes[0], "the cached file " + file.string() + " is " + why + " and is rebuilt");
    EXPECT_EQ(bytes_, built);
  };
  expect_rebuilt(good.substr(0, good.size() / 2), "truncated");
  expect_rebuilt("", "truncated");
  std::string damaged = good;
  damaged[good.size() - 1000] ^= 1;
  expect_rebuilt(damaged, "damaged");
  {
    files::FileCache other(how_.cache.place, how_.cache.limit_bytes, "0.0.0");
    other.write(make(quick_tables(), false).table_key(), built);
  }
  std::string of_other;
  {
    std::ifstream in(file, std::ios::binary);
    of_other.assign(std::istreambuf_iterator<char>(in), {});
  }
  expect_rebuilt(of_other, "of another version");
  EXPECT_EQ(ready().origin, tables::Origin::cache);

  // If nothing can be stored, one line reports it, and the tables are complete nevertheless.
  std::ofstream(directory_ / "file") << "";
  how_.cache.place = (directory_ / "file/below").string();
  const tables::Report report = ready();
  EXPECT_EQ(report.origin, tables::Origin::build);
  ASSERT_EQ(report.notes.size(), 1U);
  EXPECT_EQ(report.notes[0].rfind("nothing is cached: ", 0), 0U) << report.notes[0];
}

// Two sets of tables in turn, so that each of them has to be loaded or built again.
class TwoCachedTablesTest : public CachedTablesTest {
 protected:
  void SetUp() override {
    CachedTablesTest::SetUp();
    sets_[1].atmosphere.aerosol_density = 2.0F;
    effect_.emplace(make(sets_[0], false));
    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_EQ(prepare(i).origin, tables::Origin::build);
      built_[i] = save(*effect_);
    }
    EXPECT_NE(built_[0], built_[1]);
  }
  void TearDown() override {
    effect_.reset();
    CachedTablesTest::TearDown();
  }
  tables::Report prepare(std::size_t set) {
    EXPECT_OK(effect_->set_params(sets_[set]));
    key_ = effect_->table_key();
    return ready(*effect_);
  }
  [[nodiscard]] files::FileCache cache() const {
    return {how_.cache.place, how_.cache.limit_bytes, TYNDALL_VERSION_STRING};
  }

  std::array<Params, 2> sets_ = {quick_tables(), quick_tables()};
  std::array<std::vector<std::byte>, 2> built_;
  std::optional<Effect> effect_;
  std::string key_;
};

// Returns a file with damage of one of five kinds in a random place.
std::string damaged(std::string file, int kind, std::mt19937_64& random) {
  const std::size_t at = random() % file.size();
  switch (kind) {
    case 0: file[at] = static_cast<char>(file[at] ^ (1 << (random() % 8))); break;
    case 1: file.resize(at); break;
    case 2: file.insert(at, 1 + random() % 100, '\0'); break;
    case 3: std::fill_n(file.begin() + static_cast<std::ptrdiff_t>(at / 2), 1 + at / 4, '\xff'); break;
    default: file[at % 400] = static_cast<char>(file[at % 400] + 1 + random() % 255); break;  // header and key
  }
  return file;
}

// TYNDALL_CORRUPTIONS sets the number of damaged files.
TEST_F(TwoCachedTablesTest, SurviveRandomDamage) {
  std::array<std::string, 2> paths, good;
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(prepare(i).origin, tables::Origin::cache);
    paths[i] = cache().path(key_);
    std::ifstream in(paths[i], std::ios::binary);
    good[i].assign(std::istreambuf_iterator<char>(in), {});
  }
  const char* const count = std::getenv("TYNDALL_CORRUPTIONS");
  const int corruptions = count != nullptr ? std::atoi(count) : 3;
  std::mt19937_64 random(21);
  for (int i = 0; i < corruptions; ++i) {
    const std::size_t set = static_cast<std::size_t>(i) % 2;
    std::ofstream(paths[set], std::ios::binary) << damaged(good[set], i % 5, random);
    const tables::Report report = prepare(set);
    EXPECT_EQ(report.origin, tables::Origin::build) << i;
    ASSERT_EQ(report.notes.size(), 1U) << i;
    EXPECT_EQ(report.notes[0].find('\n'), std::string::npos);
    ASSERT_EQ(save(*effect_), built_[set]) << i;
  }
  std::cout << corruptions << " damaged files of cached tables: each was noticed and rebuilt\n";
}

// A process waits for another one that builds the same tables, and uses its result.
TEST_F(TwoCachedTablesTest, AreAwaitedWhileAnotherProcessBuildsThem) {
  EXPECT_EQ(prepare(0).origin, tables::Origin::cache);
  const std::string key = key_;
  EXPECT_EQ(prepare(1).origin, tables::Origin::cache);
  std::filesystem::remove(cache().path(key));
  auto lock = std::make_unique<files::BuildLock>(cache().try_lock(key));
  ASSERT_EQ(lock->state(), files::BuildLock::State::held);
  std::uint32_t calls = 0;
  how_.progress = [&](Progress progress) {
    EXPECT_EQ(progress.done, 0U);
    if (++calls < 3) return;
    cache().write(key, built_[0]);
    lock.reset();
  };
  EXPECT_EQ(prepare(0).origin, tables::Origin::cache);
  EXPECT_EQ(save(*effect_), built_[0]);
  EXPECT_EQ(calls, 3U);
}

TEST_F(CachedTablesTest, StayWithinTheSizeLimit) {
  Params params = quick_tables();
  const VkDeviceSize size = make(params, false).table_bytes();
  how_.cache.limit_bytes = 2 * size + 10000;
  for (const float density : {1.0F, 2.0F, 3.0F}) {
    params.atmosphere.aerosol_density = density;
    EXPECT_EQ(ready(params).origin, tables::Origin::build);
    ::usleep(20000);
  }
  EXPECT_EQ(files().size(), 2U);
  EXPECT_EQ(ready(params).origin, tables::Origin::cache);
  params.atmosphere.aerosol_density = 1.0F;
  EXPECT_EQ(ready(params).origin, tables::Origin::build);
  how_.cache.limit_bytes = size;
  params.atmosphere.aerosol_density = 9.0F;
  const tables::Report report = ready(params);
  ASSERT_EQ(report.notes.size(), 1U);
  EXPECT_NE(report.notes[0].find("exceed its limit of " + std::to_string(size)), std::string::npos);
}

// Stored pipelines are used only if their header names the device. Damaged ones are ignored.
TEST_F(SavedTablesTest, PipelinesAreStoredForTheDevice) {
  const gpu::Device& device = host().device();
  VkPipelineCacheHeaderVersionOne header = {};
  header.headerSize = sizeof header;
  header.headerVersion = VK_PIPELINE_CACHE_HEADER_VERSION_ONE;
  header.vendorID = device.properties.vendorID;
  header.deviceID = device.properties.deviceID;
  std::memcpy(header.pipelineCacheUUID, device.properties.pipelineCacheUUID, VK_UUID_SIZE);
  const auto accepted = [&](const auto& change, std::size_t size = sizeof header) {
    VkPipelineCacheHeaderVersionOne changed = header;
    change(changed);
    return tables::is_of_device(std::as_bytes(std::span(&changed, 1)).first(size), device.properties);
  };
  using Header = VkPipelineCacheHeaderVersionOne;
  EXPECT_TRUE(accepted([](Header&) {}));
  EXPECT_FALSE(accepted([](Header&) {}, sizeof header - 1));
  EXPECT_FALSE(accepted([](Header& h) { h.headerSize = 16; }));
  EXPECT_FALSE(accepted([](Header& h) { h.headerSize = 64; }));
  EXPECT_FALSE(accepted([](Header& h) { h.headerVersion = static_cast<VkPipelineCacheHeaderVersion>(2); }));
  EXPECT_FALSE(accepted([](Header& h) { ++h.vendorID; }));
  EXPECT_FALSE(accepted([](Header& h) { ++h.deviceID; }));
  EXPECT_FALSE(accepted([](Header& h) { ++h.pipelineCacheUUID[15]; }));

  std::string folder = (std::filesystem::temp_directory_path() / "tyndall-pipelines-XXXXXX").string();
  ASSERT_NE(::mkdtemp(folder.data()), nullptr);
  for (int run = 0; run < 3; ++run) {
    {
      const tables::PipelineStore store(host(), {folder});
      EXPECT_NE(device.pipeline_cache, VkPipelineCache{VK_NULL_HANDLE});
      DeviceInfo with_cache = info();
      with_cache.pipeline_cache = device.pipeline_cache;
      EXPECT_OK(Effect::create(with_cache, {.max_extent = {16, 16}}, small_tables()));
    }
    EXPECT_EQ(device.pipeline_cache, VkPipelineCache{VK_NULL_HANDLE});
    // Some drivers store nothing. The files of the others are damaged before the last run.
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
      if (run == 1 && entry.is_regular_file()) std::filesystem::resize_file(entry.path(), entry.file_size() / 2);
    }
  }
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace tyndall
