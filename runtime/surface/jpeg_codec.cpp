// In: a JPEG's bytes. Out: its texels. libjpeg leaves by longjmp: what has to be destroyed lives outside of the
// functions that it may leave.
#include <csetjmp>
#include <cstdio>  // the library's header wants it

#include <jerror.h>
#include <jpeglib.h>

#include <new>

#include "runtime/surface/picture_codecs.hpp"

namespace espalier {
namespace {

class JpegReader {
  public:
    explicit JpegReader(std::span<const std::byte> bytes) : bytes_(bytes) {
        jpeg_.err = jpeg_std_error(&errors_.library);
        errors_.library.error_exit = noteError;
        errors_.library.output_message = [](j_common_ptr) {};
    }
    ~JpegReader() { jpeg_destroy_decompress(&jpeg_); }
    JpegReader(const JpegReader&) = delete;

    // What a step of reading says; false where the library has left it.
    bool done(bool step, std::string& why) const {
        if (!step && errors_.library.msg_code == JERR_OUT_OF_MEMORY) throw std::bad_alloc();
        if (!step) why = errors_.why;
        return step;
    }
    bool readHeader() {
        if (setjmp(errors_.back)) return false;
        jpeg_create_decompress(&jpeg_);
        jpeg_mem_src(&jpeg_, reinterpret_cast<const unsigned char*>(bytes_.data()),
                     static_cast<unsigned long>(bytes_.size()));
        jpeg_read_header(&jpeg_, TRUE);
        return true;
    }
    // Four values a texel; of four inks, they are those.
    bool start() {
        if (setjmp(errors_.back)) return false;
        jpeg_.out_color_space = isInks() ? JCS_CMYK : JCS_EXT_RGBA;
        jpeg_start_decompress(&jpeg_);
        return true;
    }
    bool readRows(JSAMPLE* texels) {
        if (setjmp(errors_.back)) return false;
        while (jpeg_.output_scanline < jpeg_.output_height) {
            JSAMPROW row = texels + size_t(jpeg_.output_scanline) * jpeg_.output_width * 4;
            jpeg_read_scanlines(&jpeg_, &row, 1);
        }
        return true;
    }
    bool isInks() const { return jpeg_.jpeg_color_space == JCS_CMYK || jpeg_.jpeg_color_space == JCS_YCCK; }
    PictureSides sides() const { return {jpeg_.image_width, jpeg_.image_height}; }

  private:
    struct Errors {
        jpeg_error_mgr library;  // first: the library knows this alone
        jmp_buf back;
        char why[JMSG_LENGTH_MAX] = {};
    };
    [[noreturn]] static void noteError(j_common_ptr jpeg) {
        auto* errors = reinterpret_cast<Errors*>(jpeg->err);
        errors->library.format_message(jpeg, errors->why);
        std::longjmp(errors->back, 1);
    }

    std::span<const std::byte> bytes_;
    jpeg_decompress_struct jpeg_{};
    Errors errors_{};
};

// Inks as programs store them: as much as is left of the light.
void takeInks(std::vector<uint8_t>& texels) {
    for (size_t i = 0; i < texels.size(); i += 4) {
        const uint32_t black = texels[i + 3];
        for (size_t c = 0; c < 3; ++c) texels[i + c] = uint8_t((texels[i + c] * black + 127) / 255);
        texels[i + 3] = 255;
    }
}

}  // namespace

bool measureJpeg(std::span<const std::byte> bytes, PictureSides& out, std::string& why) {
    JpegReader reader(bytes);
    if (!reader.done(reader.readHeader(), why)) return false;
    out = reader.sides();
    return true;
}

bool decodeJpeg(std::span<const std::byte> bytes, std::vector<uint8_t>& rgba, std::string& why) {
    JpegReader reader(bytes);
    if (!reader.done(reader.readHeader() && reader.start(), why)) return false;
    rgba.resize(size_t(reader.sides().width) * reader.sides().height * 4);
    if (!reader.done(reader.readRows(rgba.data()), why)) return false;
    if (reader.isInks()) takeInks(rgba);
    return true;
}

bool decodeJpeg(std::span<const std::byte> bytes, std::vector<uint16_t>& grey, std::string& why) {
    std::vector<uint8_t> rgba;
    if (!decodeJpeg(bytes, rgba, why)) return false;
    grey.resize(rgba.size() / 4);
    for (size_t i = 0; i < grey.size(); ++i)
        grey[i] = uint16_t(257 * greyOf(rgba[4 * i], rgba[4 * i + 1], rgba[4 * i + 2]));
    return true;
}

}  // namespace espalier
