// In: charts in UV. Out: a place for each, so that charts grown by their band don't meet: masks on a grid, largest
// first, each at the lowest row and then column where it is free. The band is one texel of the coarsest level
// that the chart serves; small charts serve fewer levels.
#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <numeric>

#include "runtime/core/jobs.hpp"
#include "tools/bake/bake_mesh.hpp"

namespace espalier::bakery {
namespace {

constexpr double kBandTexels = 1.001;  // what a bilinear read reaches, of the coarsest level
constexpr double kDensity = 1.0;       // of the grid that the masks may fill, as a first guess
constexpr double kWorthScale = 0.8;    // a coarser level is worth this loss of scale

// Sets bits from `first` up to and with `last`.
void setBits(uint64_t* words, uint32_t first, uint32_t last) {
    const uint64_t from = ~uint64_t(0) << (first % 64), to = ~uint64_t(0) >> (63 - last % 64);
    if (first / 64 == last / 64) {
        words[first / 64] |= from & to;
        return;
    }
    words[first / 64] |= from;
    for (uint32_t w = first / 64 + 1; w < last / 64; ++w) words[w] = ~uint64_t(0);
    words[last / 64] |= to;
}

// The first bit from `at` on that is set, or isn't; `end` where there is none.
uint32_t findBit(const uint64_t* words, uint32_t at, uint32_t end, bool set) {
    while (at < end) {
        const uint64_t word = (set ? words[at / 64] : ~words[at / 64]) >> (at % 64);
        if (word) return std::min(end, at + uint32_t(std::countr_zero(word)));
        at = (at / 64 + 1) * 64;
    }
    return end;
}

// A set of grid cells, one bit each, row by row.
struct Mask {
    uint32_t width = 0, height = 0, words = 0;
    std::vector<uint64_t> bits;
    std::vector<std::array<uint32_t, 3>> runs;  // row, first column, length; the longest first
    glm::dvec2 origin{0};                       // of cell (0, 0), in cells, where the chart lies at this scale
    uint64_t cells = 0;

    void set(uint32_t y, uint32_t x0, uint32_t x1) { setBits(&bits[size_t(y) * words], x0, x1); }
};

constexpr uint32_t kMostCells = 1024;  // of a grid's side
constexpr uint32_t kMostWords = kMostCells / 64;

// Which cells of a square are taken. Of each row it is known for spans of 1, 2, 4... cells at which columns one begins
// that meets something taken: two of them make a span of any length.
class Grid {
  public:
    explicit Grid(uint32_t size)
        : size_(size),
          words_(size / 64),
          spans_(uint32_t(std::bit_width(size))),
          taken_(size_t(size) * spans_ * words_, 0),
          widest_(size, size) {}

    // How many free cells of a row lie side by side at most.
    uint32_t widest(uint32_t y) const { return widest_[y]; }

    // Sets blocked[x] where a run of so many cells from x + first on meets something taken; whether that leaves a bit
    // clear.
    bool block(uint32_t y, uint32_t first, uint32_t length, uint64_t* blocked) const {
        const uint32_t span = uint32_t(std::bit_width(length)) - 1;
        const uint64_t* row = rowOf(y, span);
        addFrom(row, first, blocked);
        if (length > 1u << span) addFrom(row, first + length - (1u << span), blocked);
        uint64_t open = 0;
        for (uint32_t w = 0; w < words_; ++w) open |= ~blocked[w];
        return open != 0;
    }

    void take(const Mask& mask, uint32_t x, uint32_t y) {
        for (const auto& [row, first, length] : mask.runs)
            setBits(rowOf(y + row, 0), x + first, x + first + length - 1);
        for (uint32_t row = y; row < y + mask.height; ++row) measureRow(row);
    }

  private:
    const uint64_t* rowOf(uint32_t y, uint32_t span) const { return &taken_[(size_t(y) * spans_ + span) * words_]; }
    uint64_t* rowOf(uint32_t y, uint32_t span) { return &taken_[(size_t(y) * spans_ + span) * words_]; }

    // Adds the bits of a row from bit n on.
    void addFrom(const uint64_t* row, uint32_t n, uint64_t* to) const {
        const uint32_t whole = n / 64, part = n % 64, last = words_ - 1 - whole;
        for (uint32_t w = 0; w < last; ++w) to[w] |= row[w + whole] >> part | row[w + whole + 1] << 1 << (63 - part);
        to[last] |= row[last + whole] >> part;
    }

    void measureRow(uint32_t y) {
        for (uint32_t span = 1; span < spans_; ++span) {
            std::copy_n(rowOf(y, span - 1), words_, rowOf(y, span));
            addFrom(rowOf(y, span - 1), 1u << (span - 1), rowOf(y, span));
        }
        widest_[y] = 0;
        for (uint32_t x = 0; (x = findBit(rowOf(y, 0), x, size_, false)) < size_;) {
            const uint32_t from = x;
            x = findBit(rowOf(y, 0), x, size_, true);
            widest_[y] = std::max(widest_[y], x - from);
        }
    }

    uint32_t size_, words_, spans_;
    std::vector<uint64_t> taken_;  // per row and span
    std::vector<uint32_t> widest_;
};

class Packer {
  public:
    Packer(const BakeMesh& mesh, uint32_t resolution, uint32_t levels)
        : mesh_(mesh), resolution_(resolution), levels_(levels), grid_(std::clamp(resolution / 4, 64u, 512u)) {
        uint32_t charts = mesh.chartCount();
        low_.assign(charts, glm::dvec2(1e300));
        high_.assign(charts, glm::dvec2(-1e300));
        uvArea_.assign(charts, 0);
        for (const Triangle& t : mesh.triangles) {
            uvArea_[t.chart] += std::abs(uvArea(t));
            for (glm::dvec2 uv : t.uv) {
                low_[t.chart] = glm::min(low_[t.chart], uv);
                high_[t.chart] = glm::max(high_[t.chart], uv);
            }
        }
        for (uint32_t h : borderEdges(mesh)) borders_.push_back(h);
        firstBorder_.assign(charts + 1, 0);
        for (uint32_t h : borders_) ++firstBorder_[mesh.chartOf(h) + 1];
        for (uint32_t c = 0; c < charts; ++c) firstBorder_[c + 1] += firstBorder_[c];
    }

    // First with bands for all levels; where that costs too much scale, small charts give up coarse levels, and
    // more of them, until charts fit. Finer grids waste less on bands, but take longer.
    Placement run() {
        for (; grid_ <= std::min(resolution_, kMostCells); grid_ *= 2) {
            for (double texels : {3.0, 6.0, 12.0, 24.0, 48.0, 1e9}) {
                minTexels_ = texels;
                bool last = texels > 1e6;
                double guess = scaleFor(levels_ - 1, kDensity);
                if (guess < kWorthScale && !last) continue;
                Placement placed = search(levels_ - 1, guess, last ? 0.02 : kWorthScale * 0.9);
                if (placed.scale > 0) return placed;
            }
        }
        return {};
    }

  private:
    uint32_t levelOf(uint32_t chart, double scale, uint32_t coarsest) const {
        double width = std::sqrt(uvArea_[chart]) * scale;
        uint32_t level = coarsest;
        while (level > 0 && width * double(resolution_ >> level) < minTexels_) --level;
        return level;
    }
    double bandCells(uint32_t level) const { return kBandTexels * double(grid_) / double(resolution_ >> level); }

    // A scale at which the charts and their bands should fill `density` of the grid, by their boxes' measure.
    double scaleFor(uint32_t coarsest, double density) const {
        double scale = 1.5;
        for (int i = 0; i < 40; ++i, scale *= 0.95) {
            double sum = 0;
            for (uint32_t c = 0; c < mesh_.chartCount(); ++c) {
                glm::dvec2 box = (high_[c] - low_[c]) * (scale * grid_);
                double band = 2 * bandCells(levelOf(c, scale, coarsest)) + 1,
                       area = uvArea_[c] * scale * scale * grid_ * grid_;
                // A chart fills its box partly; so does the box grown by its band.
                double fill = std::max(area / std::max(box.x * box.y, 1e-12), 0.25);
                sum += (box.x + band) * (box.y + band) * std::min(1.0, fill + 0.15);
            }
            if (sum <= density * grid_ * grid_) return scale;
        }
        return scale;
    }

    // Down from the guess to the first scale that fits.
    Placement search(uint32_t coarsest, double guess, double least) const {
        Placement best;
        double step = 0.97;
        for (double scale = guess; scale >= least; scale *= step)
            if (tryScale(coarsest, scale, best)) break;
        return best;
    }

    Mask makeMask(uint32_t chart, double scale, double band) const {
        Mask mask;
        double k = scale * grid_;
        glm::dvec2 low = low_[chart] * k - glm::dvec2(band), high = high_[chart] * k + glm::dvec2(band);
        // The chart keeps its place within a cell, so that moving it is moving whole cells.
        mask.origin = glm::dvec2(std::floor(low.x), std::floor(low.y));
        mask.width = uint32_t(std::floor(high.x) - mask.origin.x) + 1;
        mask.height = uint32_t(std::floor(high.y) - mask.origin.y) + 1;
        mask.words = (mask.width + 63) / 64;
        mask.bits.assign(size_t(mask.words) * mask.height, 0);
        auto row = [&](int64_t y, int64_t x0, int64_t x1) { mask.set(uint32_t(y), uint32_t(x0), uint32_t(x1)); };
        int64_t side = std::max(mask.width, mask.height);
        for (uint32_t i = firstBorder_[chart]; i < firstBorder_[chart + 1]; ++i) {
            glm::dvec2 a = mesh_.uvAt(borders_[i]) * k - mask.origin,
                       b = mesh_.uvAt(BakeMesh::next(borders_[i])) * k - mask.origin;
            gridSegment(a, b, band + 0.5, side, 0, mask.height, [&](int64_t y, int64_t x0, int64_t x1) {
                if (x0 < mask.width) row(y, x0, std::min(x1, int64_t(mask.width) - 1));
            });
        }
        fillInside(chart, k, mask);
        for (uint32_t y = 0; y < mask.height; ++y) findRuns(mask, y);
        std::sort(mask.runs.begin(), mask.runs.end(), [](const auto& x, const auto& y) { return x[2] > y[2]; });
        return mask;
    }

    // Cells whose centre the chart covers: even-odd over its border, row by row.
    void fillInside(uint32_t chart, double k, Mask& mask) const {
        std::vector<std::pair<int64_t, double>> at;  // row, and where a border passes its middle
        for (uint32_t i = firstBorder_[chart]; i < firstBorder_[chart + 1]; ++i) {
            glm::dvec2 a = mesh_.uvAt(borders_[i]) * k - mask.origin,
                       b = mesh_.uvAt(BakeMesh::next(borders_[i])) * k - mask.origin;
            if (a.y > b.y) std::swap(a, b);
            int64_t y0 = std::max(int64_t(0), ceilWhole(a.y - 0.5));
            int64_t y1 = std::min(int64_t(mask.height), ceilWhole(b.y - 0.5));
            for (int64_t y = y0; y < y1; ++y)
                at.emplace_back(y, a.x + (b.x - a.x) * (double(y) + 0.5 - a.y) / (b.y - a.y));
        }
        std::sort(at.begin(), at.end());
        for (size_t i = 0; i + 1 < at.size();) {
            const auto [y, from] = at[i];
            if (at[i + 1].first != y) {
                ++i;
                continue;
            }
            const int64_t x0 = std::max(int64_t(0), ceilWhole(from - 0.5));
            const int64_t x1 = std::min(int64_t(mask.width) - 1, floorWhole(at[i + 1].second - 0.5));
            if (x0 <= x1) mask.set(uint32_t(y), uint32_t(x0), uint32_t(x1));
            i += 2;
        }
    }

    static void findRuns(Mask& mask, uint32_t y) {
        const uint64_t* row = &mask.bits[size_t(y) * mask.words];
        for (uint32_t x = 0; (x = findBit(row, x, mask.width, true)) < mask.width;) {
            const uint32_t from = x;
            x = findBit(row, x, mask.width, false);
            mask.runs.push_back({y, from, x - from});
            mask.cells += x - from;
        }
    }

    bool tryScale(uint32_t coarsest, double scale, Placement& out) const {
        uint32_t charts = mesh_.chartCount();
        std::vector<Mask> masks(charts);
        parallelFor(charts, 16, [&](size_t begin, size_t end) {
            for (size_t c = begin; c < end; ++c)
                masks[c] = makeMask(uint32_t(c), scale, bandCells(levelOf(uint32_t(c), scale, coarsest)));
        });
        uint64_t cells = 0;
        for (const Mask& m : masks) {
            cells += m.cells;
            if (m.width > grid_ || m.height > grid_) return false;
        }
        if (cells > uint64_t(grid_) * grid_) return false;
        // Which order packs best is luck: all are tried, the first that fits is taken.
        std::array<std::vector<glm::dvec2>, 3> offsets;
        std::atomic<size_t> fits = offsets.size();  // the first that does, by now
        parallelFor(offsets.size(), 1, [&](size_t i, size_t) {
            offsets[i] = packInOrder(masks, i, fits);
            for (size_t known = fits; !offsets[i].empty() && i < known && !fits.compare_exchange_weak(known, i);) {
            }
        });
        for (std::vector<glm::dvec2>& offset : offsets) {
            if (offset.empty()) continue;
            out.scale = scale;
            out.offset = std::move(offset);
            out.coarsest.resize(charts);
            for (uint32_t c = 0; c < charts; ++c) out.coarsest[c] = levelOf(c, scale, coarsest);
            return true;
        }
        return false;
    }

    // Places all masks, largest first by side, cells or height. Empty: they don't fit, or an earlier order has.
    std::vector<glm::dvec2> packInOrder(const std::vector<Mask>& masks, size_t measure,
                                        const std::atomic<size_t>& fits) const {
        auto size = [&](const Mask& m) -> uint64_t {
            return measure == 0 ? std::max(m.width, m.height) : measure == 1 ? m.cells : m.height;
        };
        std::vector<uint32_t> order(masks.size());
        std::iota(order.begin(), order.end(), 0u);
        std::stable_sort(order.begin(), order.end(),
                         [&](uint32_t a, uint32_t b) { return size(masks[a]) > size(masks[b]); });
        Grid grid(grid_);
        std::vector<glm::dvec2> offset(masks.size());
        for (uint32_t c : order) {
            uint32_t x, y;
            if (fits < measure || !place(masks[c], grid, x, y)) return {};
            grid.take(masks[c], x, y);
            offset[c] = (glm::dvec2(x, y) - masks[c].origin) / double(grid_);
        }
        return offset;
    }

    // The lowest free row for a mask, then the leftmost column: all columns of a row are tried at once.
    bool place(const Mask& mask, const Grid& grid, uint32_t& outX, uint32_t& outY) const {
        std::array<uint64_t, kMostWords> outside{}, blocked;
        // Columns from which the mask would reach past the right border.
        if (mask.width > 1) setBits(outside.data(), grid_ - mask.width + 1, grid_ - 1);
        for (uint32_t y = 0; y + mask.height <= grid_; ++y) {
            const auto tooLong = [&](const auto& run) { return run[2] > grid.widest(y + run[0]); };
            if (std::any_of(mask.runs.begin(), mask.runs.end(), tooLong)) continue;
            blocked = outside;
            const auto leavesRoom = [&](const auto& run) {
                return grid.block(y + run[0], run[1], run[2], blocked.data());
            };
            if (!std::all_of(mask.runs.begin(), mask.runs.end(), leavesRoom)) continue;
            outX = findBit(blocked.data(), 0, grid_, false), outY = y;
            return true;
        }
        return false;
    }

    const BakeMesh& mesh_;
    uint32_t resolution_, levels_, grid_;
    double minTexels_ = 3;  // a chart serves the levels on which it is as wide as this
    std::vector<glm::dvec2> low_, high_;
    std::vector<double> uvArea_;
    std::vector<uint32_t> borders_, firstBorder_;
};

}  // namespace

Placement packCharts(const BakeMesh& mesh, uint32_t resolution, uint32_t levels) {
    return Packer(mesh, resolution, levels).run();
}

}  // namespace espalier::bakery
