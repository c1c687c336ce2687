#include "reconstruct/sample/layer_hashes.hpp"

#include <gmock/gmock.h>

#include "reconstruct/errors.hpp"
#include "tests/reconstruct/test_files.hpp"
#include "tests/temporary_folder.hpp"

namespace biotomy::reconstruct {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

const std::string kHash(64, 'a');

class LayerHashes : public testing::Test {
 protected:
  std::vector<LayerHash> read(const std::string& text) const {
    write_text(path_, text);
    return read_layer_hashes(path_);
  }

  tests::TemporaryFolder folder_;
  std::filesystem::path path_ = folder_ / "layers.sha256";
};

TEST_F(LayerHashes, AreReadAsTheyAreWritten) {
  const std::vector<LayerHash> hashes{{"layers/000001.tif", kHash},
                                      {"layers/000002.tif", std::string(64, '0')}};
  EXPECT_EQ(read(layer_hash_lines(hashes)), hashes);
}

TEST_F(LayerHashes, AreWrittenAsSha256sumPrintsThem) {
  EXPECT_EQ(layer_hash_lines({{"layers/000001.tif", kHash}}), kHash + "  layers/000001.tif\n");
}

TEST_F(LayerHashes, DoNotCountALineThatWasCutOff) {
  EXPECT_THAT(read(kHash + "  a.tif\n" + kHash + "  b.t"), ElementsAre(LayerHash{"a.tif", kHash}));
}

TEST_F(LayerHashes, NameALineThatMakesNoSense) {
  for (const std::string& line :
       {std::string("x"), kHash, kHash + "  ", kHash + " a.tif", "A" + kHash.substr(1) + "  a"}) {
    EXPECT_THAT(message_of<SampleError>([&] { read(kHash + "  a.tif\n" + line + "\n"); }),
                testing::AllOf(HasSubstr(path_.string()), HasSubstr("line 2")))
        << line;
  }
  EXPECT_THROW(read_layer_hashes(folder_ / "nowhere"), SampleError);
}

}  // namespace
}  // namespace biotomy::reconstruct
