// In: bytes. Out: nothing, if all goes well; of a field that is accepted all numbers are finite, and there is one
// vector or tensor for each of its points or texels.
#include <algorithm>
#include <cmath>

#include "tests/fuzz/promise.hpp"
#include "tools/scene/field_file.hpp"

namespace espalier::fuzz {

void field(Bytes bytes) {
    const MemoryFile file(bytes);
    scene::FieldFile read;
    std::string error;
    if (!scene::readFieldFile(file.path(), "flow", read, error))
        return require(error.starts_with(file.path()) && read.points.empty() && read.vectors.empty(),
                       "a failure names the file, and gives nothing");
    const size_t texels = size_t(read.width) * read.height, count = texels > 0 ? texels : read.points.size();
    require(texels == 0 || read.points.empty(), "a picture has no points");
    require(count > 0 && (read.vectors.empty() ? read.tensors.size() == 6 * count
                                               : read.vectors.size() == 3 * count && read.tensors.empty()),
            "a vector or a tensor for each of them");
    const auto finite = [](double x) { return std::isfinite(x); };
    for (const auto& point : read.points) require(std::ranges::all_of(point, finite), "points are finite");
    require(std::ranges::all_of(read.vectors, finite), "vectors are finite");
    require(std::ranges::all_of(read.tensors, finite), "tensors are finite");
}

}  // namespace espalier::fuzz
