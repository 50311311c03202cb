// In: a PLY or OpenEXR file. Out: a field as the plugin takes it. A tensor that is told in two axes becomes one in
// space, of which only the symmetric part is kept.
#include "tools/scene/field_file.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "tools/formats/ply_file.hpp"
#include "tools/scene/guarded.hpp"
#include "tools/scene/picture.hpp"
#include "tools/scene/picture_head.hpp"
#include "tools/scene/text_file.hpp"

namespace espalier::scene {
namespace {

using formats::PlyElement;
using formats::PlyFile;
using formats::PlyNames;

constexpr uint64_t kMostPoints = 1u << 24;
constexpr uint64_t kMostBytes = uint64_t(1) << 31;

// Numbers of a vertex, by their place in a row.
constexpr size_t kVector = 3, kTensor = 6, kFlat = 12, kSlots = 22;
// Where vectors and tensors begin, and how many numbers they have.
struct Form {
    size_t first, count;
};
constexpr Form kForms[] = {{kVector, 3}, {kTensor, 6}, {kFlat, 10}};

class PlyFieldReader {
  public:
    PlyFieldReader(std::string_view bytes, const std::string& field, FieldFile& out)
        : file_(bytes),
          own_{field + "_x", field + "_y", field + "_z"},
          names_{{{"x"},   {"y"},   {"z"},   {"vx", own_[0]}, {"vy", own_[1]}, {"vz", own_[2]}, {"txx"}, {"tyy"},
                  {"tzz"}, {"txy"}, {"txz"}, {"tyz"},         {"t11"},         {"t12"},         {"t21"}, {"t22"},
                  {"e1x"}, {"e1y"}, {"e1z"}, {"e2x"},         {"e2y"},         {"e2z"}}},
          out_(out) {}

    // What is wrong, with its place; empty: nothing is.
    std::string read() {
        if (std::string wrong = file_.readHeader(); !wrong.empty()) return file_.here(wrong);
        for (const PlyElement& element : file_.elements) {
            if (element.properties.empty()) continue;
            std::string wrong = file_.expect(element);
            if (wrong.empty()) wrong = element.name == "vertex" ? readVertices(element) : passOver(element);
            if (!wrong.empty()) return file_.here(wrong);
            if (element.name == "vertex") return {};
        }
        return file_.here("the file has no vertices");
    }

  private:
    std::string passOver(const PlyElement& element) {
        for (uint64_t i = 0; i < element.count; ++i)
            if (std::string wrong = file_.readRow(element, i, {}, nullptr); !wrong.empty()) return wrong;
        return {};
    }

    std::string readVertices(const PlyElement& element) {
        if (element.count == 0) return "the file has no vertices";
        if (element.count > kMostPoints) return std::to_string(element.count) + " vertices; 16777216 are the most";
        std::vector<int> slots(element.properties.size(), -1);
        std::array<int, kSlots> places;
        for (size_t slot = 0; slot < kSlots; ++slot) {
            const int at = element.find(names_[slot]);
            places[slot] = at >= 0 && !element.properties[size_t(at)].list ? at : -1;
        }
        const auto lacks = [&](const Form& form) {
            return std::find(&places[form.first], &places[form.first] + form.count, -1) - &places[form.first];
        };
        if (lacks({0, 3}) < 3) return "vertices have no x, y and z";
        const Form* form = std::ranges::find_if(kForms, [&](const Form& f) { return size_t(lacks(f)) == f.count; });
        if (form == std::end(kForms)) return missing(places);
        for (size_t slot = 0; slot < 3; ++slot) slots[size_t(places[slot])] = int(slot);
        for (size_t slot = form->first; slot < form->first + form->count; ++slot)
            slots[size_t(places[slot])] = int(slot);
        for (uint64_t i = 0; i < element.count; ++i) {
            double row[kSlots] = {};
            if (std::string wrong = file_.readRow(element, i, slots, row); !wrong.empty()) return wrong;
            for (size_t slot = 0; slot < kSlots; ++slot)
                if (!std::isfinite(float(row[slot])))
                    return "vertex " + std::to_string(i) + ": " + std::string(names_[slot][0]) + " is no finite number";
            if (!take(*form, row)) return "vertex " + std::to_string(i) + ": its tensor is no finite number";
        }
        return {};
    }

    // False: the numbers are too large together.
    bool take(const Form& form, const double* row) {
        out_.points.push_back({row[0], row[1], row[2]});
        if (form.first == kVector)
            for (size_t k = 0; k < 3; ++k) out_.vectors.push_back(float(row[kVector + k]));
        else if (form.first == kTensor)
            for (size_t k = 0; k < 6; ++k) out_.tensors.push_back(float(row[kTensor + k]));
        else
            return takeFlat(row + kFlat);
        return true;
    }
    // t11 t12 t21 t22 in the axes e1 and e2.
    bool takeFlat(const double* t) {
        const double mixed = (t[1] + t[2]) / 2, *e1 = t + 4, *e2 = t + 7;
        constexpr int kPairs[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}};
        for (const auto& [i, j] : kPairs) {
            const double number = t[0] * e1[i] * e1[j] + t[3] * e2[i] * e2[j] + mixed * (e1[i] * e2[j] + e2[i] * e1[j]);
            if (!std::isfinite(float(number))) return false;
            out_.tensors.push_back(float(number));
        }
        return true;
    }

    // Of the form that is there in part, the first number that isn't.
    std::string missing(const std::array<int, kSlots>& places) const {
        for (const Form& form : kForms)
            for (size_t slot = form.first; slot < form.first + form.count; ++slot)
                if (places[slot] < 0 &&
                    std::any_of(&places[form.first], &places[form.first] + form.count, [](int at) { return at >= 0; }))
                    return "vertices lack " + std::string(names_[slot][0]);
        return "vertices have no vectors (vx vy vz, or " + own_[0] + " " + own_[1] + " " + own_[2] +
               ") and no tensors (txx tyy tzz txy txz tyz, or t11 t12 t21 t22 in axes e1x e1y e1z e2x e2y e2z)";
    }

    PlyFile file_;
    const std::array<std::string, 3> own_;
    const std::array<PlyNames, kSlots> names_;
    FieldFile& out_;
};

bool readPicture(const std::string& path, FieldFile& out, std::string& error) {
    PictureShape shape;
    FloatPicture picture;
    if (!readShape(path, shape, error)) return false;
    if (shape.channels != 3 && shape.channels != 4) {
        error = path + ": has " + std::to_string(shape.channels) + " channels; vectors are red, green and blue";
        return false;
    }
    if (!readFloats(path, picture, error)) return false;
    out.width = picture.width;
    out.height = picture.height;
    out.vectors = std::move(picture.rgba);  // which move together in their place: a second copy would be large
    size_t kept = 0;
    for (size_t i = 0; i < out.vectors.size(); ++i) {
        if (i % 4 == 3) continue;
        if (!std::isfinite(out.vectors[i])) {
            error = path + ": texel " + std::to_string(i / 4 % picture.width) + ", " +
                    std::to_string(i / 4 / picture.width) + " holds no finite number";
            return false;
        }
        out.vectors[kept++] = out.vectors[i];
    }
    out.vectors.resize(kept);
    return true;
}

bool readAny(const std::string& path, const std::string& field, FieldFile& out, std::string& error) {
    std::string bytes;
    if (!readText(path, bytes, error, kMostBytes)) return false;
    PictureHead head;
    std::string why;
    if (bytes.starts_with("ply")) {
        if (std::string wrong = PlyFieldReader(bytes, field, out).read(); !wrong.empty())
            error = path + (std::isdigit(static_cast<unsigned char>(wrong[0])) ? ":" : ": ") + wrong;
        return error.empty();
    }
    if (readPictureHead(bytes, head, why) && std::string_view(head.format) == "openexr") {
        bytes = {};  // it is read by its name, and may be large
        return readPicture(path, out, error);
    }
    error = path + ": is neither PLY nor OpenEXR, which hold fields";
    return false;
}

}  // namespace

bool readFieldFile(const std::string& path, const std::string& field, FieldFile& out, std::string& error) {
    out = {};
    error.clear();
    const bool good = guarded(path + ": can't be read: ", error, [&] { return readAny(path, field, out, error); });
    if (!good) out = {};
    return good;
}

}  // namespace espalier::scene
