// Division and remainders against the processor's division: whole numbers as on paper, the same when the compiler works
// them out, and when a parameter or an argument is the divisor.
#include <cmath>
#include <cstring>

#include "runtime/grammar/graph.hpp"
#include "tests/grammar/support.hpp"

using namespace grammar_test;
using grammar::Graph;

namespace {

// An expression of x and y, worked out at run time.
class AtRunTime {
  public:
    explicit AtRunTime(const std::string& expression, const std::string& declared = "")
        : map_(compiled(declared + "A(x, y) -> Marching(0.1, " + expression + ", true) {A(x, y), NULL}")) {}
    void setParam(float value) { map_.setParam(0, {&value, 1}); }
    float operator()(float x, float y) const {
        Machine machine = machineFor({x, y});
        return angleOf(map_, "A", machine);
    }

  private:
    RuleMap map_;
};

float folded(float x, float y, bool remainder) {
    Graph graph;
    const grammar::Node a = graph.constant(x), b = graph.constant(y);
    const grammar::Node result = remainder ? graph.remainder(a, b) : graph.quotient(a, b);
    REQUIRE(graph.isConstant(result));
    return graph[result].value;
}

}  // namespace

TEST_CASE("whole numbers divide as on paper") {
    const AtRunTime quotient("x / y"), remainder("x % y");
    AtRunTime byParam("x / p", "param p = 2 [0 .. 100]\n"), overParam("x % p", "param p = 2 [0 .. 100]\n");
    for (int y = 2; y <= 64; ++y) {
        const float divisor = float(y);
        const std::string text = std::to_string(y);
        const AtRunTime byConstant("x / " + text), overConstant("x % " + text);
        byParam.setParam(divisor), overParam.setParam(divisor);
        uint32_t wrong = 0;
        for (int k = -400; k <= 400; ++k)
            for (int rest : {0, 1, y - 1}) {
                const float x = float(k * y + rest), r = float(rest), q = x / divisor;
                for (float got : {folded(x, divisor, true), remainder(x, divisor), overParam(x, 0), overConstant(x, 0)})
                    wrong += got != r ? 1 : 0;
                for (float got : {folded(x, divisor, false), quotient(x, divisor), byParam(x, 0), byConstant(x, 0)})
                    wrong += got != q ? 1 : 0;
                wrong += remainder(-x, -divisor) != -r ? 1 : 0;
            }
        for (int k = 1; k * y < 1 << 24; k = k * 5 / 4 + 1) {
            const float x = float(k * y);
            wrong += quotient(x, divisor) != float(k) || remainder(x, divisor) != 0 ? 1 : 0;
        }
        INFO(y);
        CHECK(wrong == 0);
    }
}

TEST_CASE("numbers divide as a processor divides them, and remainders stay below the divisor") {
    const AtRunTime quotient("x / y"), remainder("x % y");
    std::mt19937 random(5);
    auto number = [&](float low, float high) { return std::uniform_real_distribution<float>(low, high)(random); };
    uint32_t other = 0, foldedOther = 0, outside = 0, far = 0;
    for (int i = 0; i < 200'000; ++i) {
        const float scale = std::exp2(number(-20, 20)), x = number(-1000, 1000) * scale, y = number(-50, 50) * scale;
        if (std::fabs(y) < 1e-6f) continue;
        const float q = quotient(x, y), r = remainder(x, y);
        other += q != x / y ? 1 : 0;
        foldedOther += folded(x, y, false) != q || folded(x, y, true) != r ? 1 : 0;
        if (std::fabs(q) > 1e6f) continue;
        outside += (y > 0 ? r >= 0 && r < y : r <= 0 && r > y) ? 0 : 1;
        const double turns = (double(x) - double(r)) / double(y);
        far += std::fabs(turns - std::round(turns)) > 1e-6 * (1 + std::fabs(turns)) ? 1 : 0;
    }
    CHECK(other == 0);
    CHECK(foldedOther == 0);
    CHECK(outside == 0);
    CHECK(far == 0);
    for (float x : {1e-30f, 1e-16f, 1.0f, 1e17f, 1e18f})
        for (float y : {1e-30f, 1e-16f, 3.0f, 1e17f, 1e18f}) {
            CHECK(std::isfinite(quotient(x, y)));
            CHECK(std::isfinite(remainder(-x, y)));
        }
    CHECK(quotient(5, 0) == 0);
    CHECK(remainder(5, 0) == 5);
}

TEST_CASE("every eighth, as the manual has it") {
    const AtRunTime eighth("x % 8 < 1 ? 1 : 0"), seventh("x % 7 < 1 ? 1 : 0");
    for (int n = 0; n < 1000; ++n) {
        CHECK(eighth(float(n), 0) == (n % 8 == 0 ? 1.0f : 0.0f));
        CHECK(seventh(float(n), 0) == (n % 7 == 0 ? 1.0f : 0.0f));
    }
}
