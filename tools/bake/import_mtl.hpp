#pragma once

// Materials of OBJ files: .mtl libraries and the pictures that those name.

#include <functional>
#include <map>
#include <set>

#include "tools/bake/import.hpp"

namespace espalier::import {

// How a picture is laid on by the UVs: they are multiplied, then moved. v counts upwards.
struct UvScaling {
    glm::vec2 scale{1}, offset{0};
    bool operator==(const UvScaling&) const = default;
    // Of UVs whose v counts downwards, as ours does.
    glm::vec2 operator()(glm::vec2 uv) const {
        return {uv.x * scale.x + offset.x, 1 - ((1 - uv.y) * scale.y + offset.y)};
    }
};

// The materials of a model by their names. Number 0 is that of faces without one.
class MaterialLibrary {
  public:
    // path: the .obj file, for messages and as the folder to look in.
    MaterialLibrary(const std::string& path, Intake& intake, Model& model);

    // Reads what a `mtllib` line names: one or more files. What is missing becomes a warning.
    void readLibraries(std::string_view names, int line);

    // The material that a `usemtl` line names; 0, and a warning the first time, where no library has it.
    uint32_t find(std::string_view name, int line);
    const UvScaling& scaling(uint32_t material) const { return scalings_[material]; }
    // Some material has one that changes UVs.
    bool scalesAny() const;

  private:
    class File;
    void warn(int line, std::string message);
    std::vector<std::string> filesOf(std::string_view names);
    std::string placeOf(const std::string& folder, const std::vector<std::string>& names);
    // The number of the picture that is called by one of the names; -1, and a warning the first time: there is none.
    int picture(const std::string& folder, const std::vector<std::string>& names,
                const std::function<void(std::string)>& warn);

    std::string path_;
    Intake& intake_;
    Model& model_;
    std::map<std::string, uint32_t, std::less<>> names_;
    std::vector<UvScaling> scalings_;      // by material
    std::map<std::string, int> pictures_;  // by the name that is said
    std::set<std::string> unknown_;
};

}  // namespace espalier::import
