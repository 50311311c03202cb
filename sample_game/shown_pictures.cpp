// Files of pictures -> images for panels.
#include "sample_game/shown_pictures.hpp"

#include "tools/scene/picture.hpp"

namespace sample {
namespace {

constexpr uint32_t kMostSide = 1024;  // pixels; what is larger was put there by somebody else

}  // namespace

void* ShownPictures::of(const std::string& file, float& aspect) {
    std::error_code none;
    const auto written = std::filesystem::last_write_time(file, none);
    if (none) return nullptr;
    auto known = shown_.find(file);
    if (known == shown_.end() || known->second.written != written) {
        Shown shown{written, nullptr, 1};
        espalier::scene::PictureShape shape;
        espalier::scene::ColourPicture picture;
        std::string ignored;  // a picture less is no news
        if (readShape(file, shape, ignored) && shape.width <= kMostSide && shape.height <= kMostSide &&
            readColour(file, picture, ignored)) {
            shown.image = std::make_unique<HostImage>(host_);
            shown.aspect = float(picture.width) / float(picture.height);
            if (!shown.image->show(picture.rgba.data(), picture.width, picture.height)) shown.image.reset();
        }
        known = shown_.insert_or_assign(file, std::move(shown)).first;
    }
    aspect = known->second.aspect;
    return known->second.image.get();
}

}  // namespace sample
