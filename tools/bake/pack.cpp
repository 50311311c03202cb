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
        for (; grid_ <= std::min(resolution_, 1024u); grid_ *= 2) {
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
        std::vector<std::vector<double>> at(mask.height);
        for (uint32_t i = firstBorder_[chart]; i < firstBorder_[chart + 1]; ++i) {
            glm::dvec2 a = mesh_.uvAt(borders_[i]) * k - mask.origin,
                       b = mesh_.uvAt(BakeMesh::next(borders_[i])) * k - mask.origin;
            if (a.y > b.y) std::swap(a, b);
            int64_t y0 = std::max(int64_t(0), int64_t(std::ceil(a.y - 0.5)));
            int64_t y1 = std::min(int64_t(mask.height), int64_t(std::ceil(b.y - 0.5)));
            for (int64_t y = y0; y < y1; ++y)
                at[size_t(y)].push_back(a.x + (b.x - a.x) * (double(y) + 0.5 - a.y) / (b.y - a.y));
        }
        for (uint32_t y = 0; y < mask.height; ++y) {
            auto& x = at[y];
            std::sort(x.begin(), x.end());
            for (size_t i = 0; i + 1 < x.size(); i += 2) {
                int64_t x0 = std::max(int64_t(0), int64_t(std::ceil(x[i] - 0.5)));
                int64_t x1 = std::min(int64_t(mask.width) - 1, int64_t(std::floor(x[i + 1] - 0.5)));
                if (x0 <= x1) mask.set(y, uint32_t(x0), uint32_t(x1));
            }
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
            for (const auto& [row, first, length] : masks[c].runs)
                setBits(&grid.taken[size_t(y + row) * grid.words], x + first, x + first + length - 1);
            for (uint32_t row = y; row < y + masks[c].height; ++row) grid.widest[row] = widestGap(grid, row);
            offset[c] = (glm::dvec2(x, y) - masks[c].origin) / double(grid_);
        }
        return offset;
    }

    // What is taken, and of each row how many free cells there are at most side by side.
    struct Grid {
        explicit Grid(uint32_t size)
            : words(size / 64), taken(size_t(words) * size, 0), widest(size, size), blocked(words), shifted(words) {}
        uint32_t words;
        std::vector<uint64_t> taken;
        std::vector<uint32_t> widest;
        std::vector<uint64_t> blocked, shifted, other;  // scratch: a row each
    };
    uint32_t widestGap(const Grid& grid, uint32_t y) const {
        const uint64_t* row = &grid.taken[size_t(y) * grid.words];
        uint32_t most = 0;
        for (uint32_t x = 0; (x = findBit(row, x, grid_, false)) < grid_;) {
            const uint32_t from = x;
            x = findBit(row, x, grid_, true);
            most = std::max(most, x - from);
        }
        return most;
    }

    // bits[x] of `row` shifted down by n: result bit x is bit x + n.
    static void shiftDown(std::vector<uint64_t>& row, uint32_t n) {
        uint32_t whole = n / 64, part = n % 64;
        size_t words = row.size();
        for (size_t i = 0; i < words; ++i) {
            uint64_t low = i + whole < words ? row[i + whole] : 0;
            uint64_t high = i + whole + 1 < words ? row[i + whole + 1] : 0;
            row[i] = part == 0 ? low : low >> part | high << (64 - part);
        }
    }

    // The lowest free row for a mask, then the leftmost column: all columns of a row are tried at once.
    bool place(const Mask& mask, Grid& grid, uint32_t& outX, uint32_t& outY) const {
        const uint32_t words = grid.words;
        std::vector<uint64_t>&blocked = grid.blocked, &shifted = grid.shifted, &other = grid.other;
        for (uint32_t y = 0; y + mask.height <= grid_; ++y) {
            bool narrow = false;
            for (size_t i = 0; i < mask.runs.size() && !narrow; ++i)
                narrow = mask.runs[i][2] > grid.widest[y + mask.runs[i][0]];
            if (narrow) continue;
            for (uint32_t w = 0; w < words; ++w) {
                // Columns from which the mask would reach past the right border.
                uint64_t b = 0;
                for (uint32_t i = 0; i < 64; ++i)
                    if (w * 64 + i + mask.width > grid_) {
                        b = ~uint64_t(0) << i;
                        break;
                    }
                blocked[w] = b;
            }
            bool full = false;
            for (const auto& [row, first, length] : mask.runs) {
                const uint64_t* from = &grid.taken[size_t(y + row) * words];
                uint64_t any = 0;
                for (uint32_t w = 0; w < words; ++w) any |= shifted[w] = from[w];
                if (!any) continue;
                // Bit x of `shifted` becomes: any of bits x to x + length - 1 is taken.
                for (uint32_t have = 1; have < length;) {
                    uint32_t step = std::min(have, length - have);
                    other = shifted;
                    shiftDown(other, step);
                    for (uint32_t w = 0; w < words; ++w) shifted[w] |= other[w];
                    have += step;
                }
                shiftDown(shifted, first);
                uint64_t open = 0;
                for (uint32_t w = 0; w < words; ++w) open |= ~(blocked[w] |= shifted[w]);
                if (!open) {
                    full = true;
                    break;
                }
            }
            if (full) continue;
            for (uint32_t w = 0; w < words; ++w)
                if (~blocked[w]) {
                    outX = w * 64 + uint32_t(std::countr_one(blocked[w]));
                    outY = y;
                    return true;
                }
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
