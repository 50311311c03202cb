// Fields of other programs: what they say, and what is told of hostile ones.
#include "tools/scene/field_file.hpp"

#include <doctest/doctest.h>

#include <fstream>

#include "tests/support/data.hpp"
#include "tests/support/scratch_folder.hpp"

using namespace espalier::scene;
using namespace espalier::test;

namespace {

const std::string kCorpus = "tests/fuzz/corpus/field/";

FieldFile readGood(const std::string& path) {
    FieldFile file;
    std::string error;
    REQUIRE_MESSAGE(readFieldFile(path, "flow", file, error), error);
    return file;
}

std::string bytesOf(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

struct Files {
    ScratchFolder folder;
    std::string write(const std::string& bytes) const {
        const std::string path = (folder.path / "a.ply").string();
        std::ofstream(path, std::ios::binary) << bytes;
        return path;
    }
    // What is told of such a file, behind its name.
    std::string told(const std::string& bytes) const {
        const std::string path = write(bytes);
        FieldFile file;
        std::string error;
        REQUIRE_FALSE(readFieldFile(path, "flow", file, error));
        CHECK(file.points.empty());
        REQUIRE(error.starts_with(path));
        return error.substr(path.size());
    }
};

std::string text(const std::string& count, const std::string& properties, const std::string& rows) {
    std::string all = "ply\nformat ascii 1.0\nelement vertex " + count + "\n";
    for (size_t at = 0; at < properties.size();) {
        const size_t end = std::min(properties.find(' ', at), properties.size());
        all += "property float " + properties.substr(at, end - at) + "\n";
        at = end + 1;
    }
    return all + "end_header\n" + rows;
}

}  // namespace

TEST_CASE("vectors, tensors and pictures are read as they were written") {
    const FieldFile vectors = readGood(kCorpus + "vectors.ply");
    CHECK(vectors.points == std::vector<std::array<double, 3>>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
    CHECK(vectors.vectors == std::vector<float>{1, 0, 0, 1, 0, -.5f, 1, .5f, 0, 2, 0, 0});
    CHECK(readGood(kCorpus + "own_name.ply").vectors == std::vector<float>{1, 0, 0, 0, 1, 0});
    const FieldFile tensors = readGood(kCorpus + "tensors.ply");
    CHECK(tensors.tensors == std::vector<float>{3, 1, 0, .5f, 0, 0, 2, 1, 0, 0, 0, .25f});
    // 3 along y, 1 along z; of 1 and -0.5 between them the mean is symmetric.
    CHECK(readGood(kCorpus + "axes.ply").tensors == std::vector<float>{0, 3, 1, 0, 0, .25f});
    const FieldFile picture = readGood(kCorpus + "vectors.exr");
    CHECK(picture.width == 3);
    CHECK(picture.height == 2);
    CHECK(std::vector<float>(picture.vectors.begin() + 12, picture.vectors.begin() + 15) ==
          std::vector<float>{.25f, -1, .5f});
}

TEST_CASE("a coordinate far from the origin keeps the digits that a double has") {
    const Files files;
    const std::string header =
        "ply\nformat ascii 1.0\nelement vertex 1\nproperty double x\nproperty double y\nproperty double z\n"
        "property float vx\nproperty float vy\nproperty float vz\nend_header\n";
    const FieldFile file = readGood(files.write(header + "500000.125 4000000.0625 7 1 0 0\n"));
    CHECK(file.points[0] == std::array<double, 3>{500000.125, 4000000.0625, 7});
}

TEST_CASE("a hostile field is refused with its file, the place and the cause") {
    const Files files;
    const std::string xyz = "x y z ";
    CHECK(files.told("") == ": is neither PLY nor OpenEXR, which hold fields");
    CHECK(files.told("plyx") == ":1: the header has no end_header");
    CHECK(files.told("ply\nformat ascii 1.0\nend_header\n") == ":4: the file has no vertices");
    CHECK(files.told(text("0", xyz + "vx vy vz", "")) == ":11: the file has no vertices");
    CHECK(files.told(text("1", "x y vx vy vz", "0 0 1 0 0")) == ":10: vertices have no x, y and z");
    CHECK(files.told(text("1", xyz + "vx vy", "0 0 0 1 0")) == ":10: vertices lack vz");
    CHECK(files.told(text("1", xyz + "t11 t12 t21 t22", "0 0 0 1 0 0 1")) == ":12: vertices lack e1x");
    CHECK(files.told(text("1", "x y z", "0 0 0")).find("have no vectors (vx vy vz, or flow_x flow_y flow_z)") !=
          std::string::npos);
    CHECK(files.told(text("2", xyz + "vx vy vz", "0 0 0 1 0 0\n1 0 0 1 nan 0\n")) ==
          ":12: vertex 1: vy is no finite number");
    CHECK(files.told(text("1", xyz + "vx vy vz", "1e39 0 0 1 0 0\n")) == ":11: vertex 0: x is no finite number");
    CHECK(files.told(text("2", xyz + "vx vy vz", "0 0 0 1 0 0\n1.50 0 0 1 0\n")) ==
          ":13: vertex 1: the file ends or holds no number here");
    CHECK(files.told(text("999999999999", xyz + "vx vy vz", "0 0 0 1 0 0\n")) ==
          ":11: the file ends before the 999999999999 elements 'vertex' that its header states");
    CHECK(files.told(bytesOf(kCorpus + "huge_axes.ply")).find("vertex 0: its tensor is no finite number") !=
          std::string::npos);
    const std::string binary = bytesOf(kCorpus + "tensors.ply");
    const std::string cut = files.told(binary.substr(0, binary.size() - 3));
    CHECK(cut.find(": byte ") == 0);
    CHECK(cut.find("vertex 1: the file ends") != std::string::npos);
    CHECK(files.told(bytesOf("tests/fuzz/corpus/picture/rgb.png")) ==
          ": is neither PLY nor OpenEXR, which hold fields");
    CHECK(files.told(bytesOf("tests/fuzz/corpus/picture/grey.exr")) ==
          ": has 1 channels; vectors are red, green and blue");
    std::string picture = bytesOf(kCorpus + "vectors.exr");
    const std::string nan("\0\0\xC0\x7F", 4);
    CHECK(files.told(picture.substr(0, picture.size() - 4) + nan) == ": texel 2, 1 holds no finite number");
    CHECK(files.told(picture.substr(0, picture.size() - 9)).find(": is damaged") == 0);
    FieldFile file;
    std::string error;
    CHECK_FALSE(readFieldFile("no such.ply", "flow", file, error));
    CHECK(error.find("no such.ply") == 0);
}
