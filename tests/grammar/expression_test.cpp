// The interpreter against an evaluation in double that shares no code with it: the test makes random expressions as
// text and works out their value and error bound itself.
#include <cmath>

#include "tests/grammar/support.hpp"

using namespace grammar_test;

namespace {

// An expression, its value, and how far rounding in float may take the machine's result from it.
struct Sample {
    std::string text;
    double value = 0, error = 0;
    bool usable = true;  // false: near a jump, or out of the range in which the error is bounded
};

class Maker {
  public:
    explicit Maker(uint32_t seed) : random_(seed) {
        for (double& a : args) a = static_cast<float>(uniform(-3, 3));
        for (double& p : params) p = static_cast<float>(uniform(-2, 2));
    }
    double args[4], params[2];

    Sample make(int depth) {
        if (depth == 0 || integer(8) == 0) return leaf();
        Sample a = make(depth - 1);
        switch (integer(18)) {
            case 0:
                return sum(a, make(depth - 1), 1);
            case 1:
                return sum(a, make(depth - 1), -1);
            case 2:
            case 3:
                return product(a, make(depth - 1));
            case 4:
                return quotient(a, make(depth - 1));
            case 5:
                return extreme(a, make(depth - 1), "min");
            case 6:
                return extreme(a, make(depth - 1), "max");
            case 7:
                return function(a, "abs", std::fabs(a.value), a.error);
            case 8:
                return function(a, "sin", std::sin(a.value), a.error + 2e-6, std::fabs(a.value) < 500);
            case 9:
                return function(a, "cos", std::cos(a.value), a.error + 2e-6, std::fabs(a.value) < 500);
            case 10:
                return root(a);
            case 11:
                return jump(a, "floor", std::floor(a.value));
            case 12:
                return jump(a, "fract", a.value - std::floor(a.value));
            case 13:
                return jump(a, "ceil", std::ceil(a.value));
            case 14:
                return mixed(a, make(depth - 1), make(depth - 1));
            case 15:
                return clamped(a);
            case 16:
                return powered(a);
            default:
                return choice(a, make(depth - 1), make(depth - 1), make(depth - 1));
        }
    }

  private:
    double uniform(double a, double b) { return std::uniform_real_distribution<double>(a, b)(random_); }
    int integer(int n) { return static_cast<int>(random_() % static_cast<uint32_t>(n)); }
    static Sample rounded(Sample s) {
        s.error += std::fabs(s.value) * 2e-7 + 1e-12;
        s.usable = s.usable && std::fabs(s.value) < 1e6 && s.error < 1e-2 * (1 + std::fabs(s.value));
        return s;
    }
    Sample leaf() {
        int kind = integer(3);
        if (kind == 0) {
            int i = integer(4);
            return {std::string(1, "xyzw"[i]), args[i], 0, true};
        }
        if (kind == 1) {
            int i = integer(2);
            return {i == 0 ? "p" : "q", params[i], 0, true};
        }
        float v = static_cast<float>(integer(40)) / 8;
        return {std::to_string(v), v, 0, true};
    }
    Sample sum(const Sample& a, const Sample& b, double sign) {
        return rounded({"(" + a.text + (sign > 0 ? " + " : " - ") + b.text + ")", a.value + sign * b.value,
                        a.error + b.error + (std::fabs(a.value) + std::fabs(b.value)) * 1e-7, a.usable && b.usable});
    }
    Sample product(const Sample& a, const Sample& b) {
        double e = std::fabs(a.value) * b.error + std::fabs(b.value) * a.error + a.error * b.error;
        // Factors may be gathered, so a sum's parts count before they cancel.
        e += (std::fabs(a.value) + 1) * (std::fabs(b.value) + 1) * 2e-6;
        return rounded({"(" + a.text + " * " + b.text + ")", a.value * b.value, e, a.usable && b.usable});
    }
    Sample quotient(const Sample& a, const Sample& b) {
        double divisor = std::fabs(b.value) + 0.5;
        double e = a.error / divisor + std::fabs(a.value) * b.error / (divisor * divisor) +
                   std::fabs(a.value / divisor) * 4e-6 + 4e-6;
        return rounded({"(" + a.text + " / (abs(" + b.text + ") + 0.5))", a.value / divisor, e, a.usable && b.usable});
    }
    Sample extreme(const Sample& a, const Sample& b, const char* name) {
        double v = name[1] == 'i' ? std::min(a.value, b.value) : std::max(a.value, b.value);
        return rounded(
            {std::string(name) + "(" + a.text + ", " + b.text + ")", v, a.error + b.error, a.usable && b.usable});
    }
    Sample function(const Sample& a, const char* name, double v, double e, bool ok = true) {
        return rounded({std::string(name) + "(" + a.text + ")", v, e, a.usable && ok});
    }
    Sample root(const Sample& a) {
        double v = std::sqrt(std::fabs(a.value));
        return rounded({"sqrt(abs(" + a.text + "))", v, a.error / (2 * v + 1e-9) + v * 1e-6, a.usable && v > 0.05});
    }
    Sample jump(const Sample& a, const char* name, double v) {
        double off = std::fabs(a.value - std::round(a.value));
        return rounded({std::string(name) + "(" + a.text + ")", v, a.error, a.usable && off > 2 * a.error + 1e-4});
    }
    Sample mixed(const Sample& a, const Sample& b, const Sample& t) {
        Sample s = sum(product(t, sum(b, a, -1)), a, 1);
        s.text = "mix(" + a.text + ", " + b.text + ", " + t.text + ")";
        return s;
    }
    Sample clamped(const Sample& a) {
        return rounded(
            {"clamp(" + a.text + ", -0.75, 1.5)", std::min(std::max(a.value, -0.75), 1.5), a.error, a.usable});
    }
    Sample powered(const Sample& a) {
        Sample s = product(product(a, a), a);
        s.text = "pow(" + a.text + ", 3)";
        return s;
    }
    Sample choice(const Sample& a, const Sample& b, const Sample& yes, const Sample& no) {
        static const char* kTests[] = {"<", "<=", ">", ">=", "!="};
        int t = integer(5);
        bool truth = t == 4 ? true : t < 2 ? a.value < b.value : a.value > b.value;
        bool clear = std::fabs(a.value - b.value) > 2 * (a.error + b.error) + 1e-4;
        const Sample& taken = truth ? yes : no;
        std::string text = "(" + a.text + " " + kTests[t] + " " + b.text + " ? " + yes.text + " : " + no.text + ")";
        return rounded({text, taken.value, taken.error, a.usable && b.usable && yes.usable && no.usable && clear});
    }
    std::mt19937 random_;
};

float evaluated(const std::string& expression, const std::vector<float>& args) {
    RuleMap map = compiled("A(x, y, z, w) -> Marching(0.1, " + expression + ", true) {A(x, y, z, w), NULL}");
    Machine machine = machineFor(args);
    return angleOf(map, "A", machine);
}

}  // namespace

TEST_CASE("the interpreter agrees with an evaluation of its own in double") {
    int compared = 0;
    for (uint32_t seed = 1; seed <= 3000; ++seed) {
        Maker maker(seed);
        Sample s = maker.make(1 + static_cast<int>(seed % 4));
        if (!s.usable) continue;
        std::string text = "param p = 0 [-2 .. 2] param q = 0 [-2 .. 2]\nA(x, y, z, w) -> Marching(0.1, " + s.text +
                           ", true) {A(x, y, z, w), NULL}";
        Result<RuleMap> map = compileGrammar(text);
        if (!map) {
            // The one limit that a random expression may meet.
            INFO(map.failure().text());
            CHECK(map.failure().text().find("registers") != std::string::npos);
            continue;
        }
        for (uint32_t i = 0; i < map->params().size(); ++i) {
            float v = static_cast<float>(maker.params[map->params()[i].name == "p" ? 0 : 1]);
            map->setParam(i, {&v, 1});
        }
        Machine machine = machineFor({static_cast<float>(maker.args[0]), static_cast<float>(maker.args[1]),
                                      static_cast<float>(maker.args[2]), static_cast<float>(maker.args[3])});
        float result = angleOf(*map, "A", machine);
        INFO(s.text);
        CHECK(std::fabs(result - s.value) <= 4 * s.error + 1e-6);
        ++compared;
    }
    MESSAGE(compared << " expressions compared");
    CHECK(compared > 1000);
}

TEST_CASE("logic, precedence and the meaning of numbers as conditions") {
    auto value = [](const char* text) { return evaluated(text, {2, 3, 0, 0}); };
    CHECK(value("1 + 2 * 3 - 4 / 2") == 5.0f);
    CHECK(value("7 - 2 - 1") == 4.0f);
    CHECK(value("-x * -y") == 6.0f);
    CHECK(value("7 % 4 + -1 % 4") == 6.0f);
    CHECK(value("x < y and not (y < x) ? 10 : 20") == 10.0f);
    CHECK(value("x > y or z > 1 ? 10 : 20") == 20.0f);
    CHECK(value("!z && x == 2 || false ? 1 : 2") == 1.0f);
    CHECK(value("z ? 1 : y ? 5 : 6") == 5.0f);
    CHECK(value("0.49 ? 1 : 2") == 2.0f);
    CHECK(value("0.5 ? 1 : 2") == 1.0f);
    CHECK(value("sign(-x) + sign(y) + sign(z)") == 0.0f);
    CHECK(value("smoothstep(0, 4, x)") == doctest::Approx(0.5));
    CHECK(value("x / z") == 0.0f);
    CHECK(value("sqrt(-x)") == 0.0f);
    CHECK(value("pi") == doctest::Approx(3.14159265));
}

TEST_CASE("no arithmetic leaves the finite numbers") {
    for (const char* text :
         {"pow(pow(x, 8), 8)", "pow(pow(x, 8), 8) - pow(pow(x, 8), 8) * 2", "x / (z * 0.0000001)", "sin(pow(x, 8))",
          "floor(pow(x, 8) * pow(x, 8))", "(x - x) / (y - y)", "1e9 * 1e9 * x * x"}) {
        float r = evaluated(text, {1e9f, -1e9f, 1e-30f, 0});
        INFO(text);
        CHECK(std::isfinite(r));
        CHECK(std::fabs(r) <= 1e18f);
    }
}
