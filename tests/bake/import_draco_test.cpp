// Draco as encoders write it: every component type, normalised or not, whether or not Draco's own mark says so. What
// the numbers mean is the accessors' to say.
#include <doctest/doctest.h>
#include <draco/compression/encode.h>

#include <cmath>

#include "tests/bake/gltf_maker.hpp"

using namespace espalier;
using namespace espalier::test;

namespace {

template <class T>
constexpr draco::DataType dracoTypeOf() {
    if constexpr (std::is_same_v<T, int8_t>) return draco::DT_INT8;
    if constexpr (std::is_same_v<T, uint8_t>) return draco::DT_UINT8;
    if constexpr (std::is_same_v<T, int16_t>) return draco::DT_INT16;
    if constexpr (std::is_same_v<T, uint16_t>) return draco::DT_UINT16;
    return draco::DT_FLOAT32;
}

// A triangle as Draco packs it, attribute by attribute.
class Packer {
  public:
    explicit Packer(GltfMaker& maker) : maker_(maker) {
        mesh_.set_num_points(3);
        mesh_.SetNumFaces(1);
        mesh_.SetFace(draco::FaceIndex(0), {draco::PointIndex(0), draco::PointIndex(1), draco::PointIndex(2)});
    }

    // marked: Draco's own word that the integers are normalised; normalized: the accessor's.
    template <class T>
    void add(const char* name, draco::GeometryAttribute::Type kind, int components, const std::vector<T>& values,
             bool normalized, bool marked) {
        draco::GeometryAttribute attribute;
        attribute.Init(kind, nullptr, uint8_t(components), dracoTypeOf<T>(), marked,
                       int64_t(components) * int64_t(sizeof(T)), 0);
        const int id = mesh_.AddAttribute(attribute, true, 3);
        for (uint32_t i = 0; i < 3; ++i)
            mesh_.attribute(id)->SetAttributeValue(draco::AttributeValueIndex(i), &values[i * size_t(components)]);
        packed_[name] = mesh_.attribute(id)->unique_id();
        nlohmann::json accessor = {
            {"componentType", componentTypeOf<T>()}, {"count", 3}, {"type", "VEC" + std::to_string(components)}};
        if (normalized) accessor["normalized"] = true;
        attributes_[name] = maker_.addAccessor(accessor);
    }

    void finish() {
        draco::Encoder encoder;
        encoder.SetEncodingMethod(draco::MESH_SEQUENTIAL_ENCODING);
        draco::EncoderBuffer bytes;
        REQUIRE(encoder.EncodeMeshToBuffer(mesh_, &bytes).ok());
        const int view = maker_.addView(std::as_bytes(std::span(bytes.data(), bytes.size())));
        const int indices = maker_.addAccessor({{"componentType", 5123}, {"count", 3}, {"type", "SCALAR"}});
        maker_.setMesh(
            {{"attributes", attributes_},
             {"indices", indices},
             {"extensions", {{"KHR_draco_mesh_compression", {{"bufferView", view}, {"attributes", packed_}}}}}});
        maker_.root["extensionsUsed"] = {"KHR_draco_mesh_compression"};
    }

  private:
    GltfMaker& maker_;
    draco::Mesh mesh_;
    nlohmann::json packed_, attributes_;
};

using Kind = draco::GeometryAttribute;

const std::vector<float> kCorners = {0, 0, 0, 1, 0, 0, 0, 1, 0};

// Stores numbers from -1 or 0 to 1 as this type does, by what the accessor will say.
template <class T>
std::vector<T> stored(const std::vector<float>& values, bool normalized) {
    std::vector<T> out;
    for (float v : values) out.push_back(T(normalized ? std::round(v * float(std::numeric_limits<T>::max())) : v));
    return out;
}

template <class T>
void checkType() {
    const bool isSigned = std::is_signed_v<T>;
    for (bool normalized : {false, true})
        for (bool marked : {false, true}) {
            CAPTURE(componentTypeOf<T>());
            CAPTURE(normalized);
            CAPTURE(marked);
            const std::vector<float> places = {0, 0, 0, 1, 0, 0, isSigned ? -1.0f : 0.0f, 1, 0};
            const std::vector<float> normals = {0, 0, 1, 0, 1, 0, isSigned ? -1.0f : 1.0f, 0, 0};
            const std::vector<float> uvs = {0, 0, 1, 0, 0, 1};
            GltfMaker maker;
            Packer packer(maker);
            packer.add("POSITION", Kind::POSITION, 3, stored<T>(places, normalized), normalized, marked);
            packer.add("NORMAL", Kind::NORMAL, 3, stored<T>(normals, normalized), normalized, marked);
            packer.add("TEXCOORD_0", Kind::TEX_COORD, 2, stored<T>(uvs, normalized), normalized, marked);
            packer.finish();
            const Model model = maker.importOrFail();
            REQUIRE(model.positions.size() == 3);
            for (size_t v = 0; v < 3; ++v)
                for (int k = 0; k < 3; ++k) {
                    CHECK(model.positions[v][k] == places[v * 3 + size_t(k)]);
                    CHECK(model.normals[v][k] == normals[v * 3 + size_t(k)]);
                    if (k < 2) CHECK(model.uvs[v][k] == uvs[v * 2 + size_t(k)]);
                }
            CHECK(model.warnings.empty());
        }
}

}  // namespace

TEST_CASE("Draco's integers mean what their accessors say, for every attribute and type") {
    checkType<int8_t>();
    checkType<uint8_t>();
    checkType<int16_t>();
    checkType<uint16_t>();
}

TEST_CASE("Draco's floats, and quantised positions that aren't normalised, are taken as they are") {
    GltfMaker maker;
    Packer packer(maker);
    packer.add("POSITION", Kind::POSITION, 3, std::vector<int16_t>{0, 0, 0, 300, 0, 0, 0, -300, 0}, false, false);
    packer.add("TEXCOORD_0", Kind::TEX_COORD, 2, std::vector<float>{0, 0, 2.5f, 0, 0, -1.25f}, false, false);
    packer.finish();
    const Model model = maker.importOrFail();
    CHECK(model.positions[1] == glm::vec3(300, 0, 0));
    CHECK(model.positions[2] == glm::vec3(0, -300, 0));
    CHECK(model.uvs[1] == glm::vec2(2.5f, 0));
    CHECK(model.uvs[2] == glm::vec2(0, -1.25f));
}

TEST_CASE("joints and weights come through Draco too") {
    GltfMaker maker;
    Packer packer(maker);
    packer.add("POSITION", Kind::POSITION, 3, kCorners, false, false);
    packer.add("JOINTS_0", Kind::GENERIC, 4, std::vector<uint8_t>{0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0}, false, false);
    packer.add("WEIGHTS_0", Kind::GENERIC, 4, std::vector<uint8_t>{255, 0, 0, 0, 255, 0, 0, 0, 51, 204, 0, 0}, true,
               false);
    packer.finish();
    maker.root["nodes"] = {{{"mesh", 0}, {"skin", 0}}, {{"name", "still"}}, {{"translation", {10, 0, 0}}}};
    maker.root["scenes"] = {{{"nodes", {0, 1, 2}}}};
    maker.root["skins"] = {{{"joints", {1, 2}}}};
    const Model model = maker.importOrFail();
    CHECK(model.positions[0].x == doctest::Approx(0));
    CHECK(model.positions[1].x == doctest::Approx(11));
    CHECK(model.positions[2].x == doctest::Approx(8));
}
