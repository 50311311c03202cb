#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include "sample_game/host_image.hpp"

namespace sample {

// Small pictures of files that panels show, read when they are first asked for and again when their files have changed.
// One thread; what was given lives until the end, or until its file has changed.
class ShownPictures {
  public:
    explicit ShownPictures(const VulkanHost& host) : host_(host) {}

    // An ImTextureID, and the picture's width by its height in `aspect`; null: there is no such file, or it can't be
    // read.
    void* of(const std::string& file, float& aspect);

  private:
    struct Shown {
        std::filesystem::file_time_type written;
        std::unique_ptr<HostImage> image;  // null: it couldn't be read
        float aspect = 1;
    };

    const VulkanHost& host_;
    std::map<std::string, Shown> shown_;
};

}  // namespace sample
