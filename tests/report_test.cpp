/// Reports of error against run time, as the program writes them, and whether their pages open in a browser.
#include "measure/report.h"
#include "program.h"
#include <cmath>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>
#include <random>
#include <sstream>

namespace vkpm {
namespace {

using namespace testing;

TEST(ReportRows, AreDueAtPassesThatGrowByTheRootOfTwo) {
    std::vector<uint> passes;
    for (uint pass = 1; pass <= 100; pass++)
        if (Report::due(pass)) passes.push_back(pass);
    EXPECT_THAT(passes, ElementsAre(1, 2, 3, 4, 6, 8, 11, 16, 23, 32, 45, 64, 91));
}

TEST(FittedSlope, IsThatOfAPowerLaw) {
    const std::vector<double> xs{1, 2, 5, 11, 0, 40}, zero{0, 0, 0, 0, 0, 0};
    std::vector<double> ys;
    for (const double x : xs) ys.push_back(3 * std::pow(x, -0.4));
    EXPECT_NEAR(fittedSlope(xs, ys), -0.4, 1e-12);
    EXPECT_TRUE(std::isnan(fittedSlope(xs, zero)));
    EXPECT_TRUE(std::isnan(fittedSlope(std::vector<double>{2, 2}, std::vector<double>{1, 3})));
}

using Row = std::map<std::string, std::string>;

class ReportProgram : public Program {
protected:
    std::vector<Row> rows(const std::string& layer) const {
        std::ifstream file(folder / "report/error.csv");
        std::string line, header;
        std::getline(file, header);
        std::vector<Row> found;
        while (std::getline(file, line)) {
            Row row;
            std::istringstream names(header), values(line + ",");
            for (std::string name, value; std::getline(names, name, ',') && std::getline(values, value, ',');)
                row[name] = value;
            if (row["layer"] == layer) found.push_back(row);
        }
        return found;
    }
    const std::string render =
        "--scene " + scene("box") + " --size 32x24 --photons 3000 --caustic-photons 3000 --quiet ";
};

TEST_F(ReportProgram, MeasuresTheErrorAgainstAReference) {
    ASSERT_EQ(run(render + "--passes 64 --seed 7 -o reference.exr").code, 0);
    const Result result = run(render + "--passes 24 -o a.exr --stats a.json --reference reference.exr --report report");
    ASSERT_EQ(result.code, 0) << result.output;

    const std::vector<Row> beauty = rows("beauty");
    std::vector<std::string> passes;
    for (const Row& row : beauty) passes.push_back(row.at("pass"));
    EXPECT_THAT(passes, ElementsAre("1", "2", "3", "4", "6", "8", "11", "16", "23", "24"));
    for (const char* layer : {"emission", "direct", "specular", "caustic", "indirect"})
        EXPECT_EQ(rows(layer).size(), beauty.size()) << layer;
    EXPECT_LT(std::stod(beauty.back().at("true_error")), std::sqrt(std::stod(beauty.back().at("relmse"))));
    EXPECT_LT(std::stod(beauty.back().at("relmse")), 0.2 * std::stod(beauty.front().at("relmse")));
    EXPECT_EQ(beauty.front().at("error"), ""); // one pass does not know
    for (std::size_t i = 1; i < beauty.size(); i++) {
        EXPECT_GT(std::stod(beauty[i].at("error")), std::stod(beauty[i].at("least"))) << i;
        EXPECT_GT(std::stod(beauty[i].at("seconds")), std::stod(beauty[i - 1].at("seconds"))) << i;
        EXPECT_GT(std::stoull(beauty[i].at("rays")), std::stoull(beauty[i - 1].at("rays"))) << i;
    }
    const std::uint64_t emitted = 24ull * 6000;
    EXPECT_EQ(std::stoull(beauty.back().at("photons")), emitted);

    // The last row is what vkpm compare and the statistics say.
    const Result compared = run("compare a.exr reference.exr --json");
    ASSERT_EQ(compared.code, 0) << compared.output;
    const auto layers = nlohmann::json::parse(compared.output)["layers"];
    for (const char* layer : {"beauty", "caustic", "indirect"})
        for (const char* measure : {"rmse", "relmse", "mean_error", "flip", "error"}) {
            const double expected = layers[layer][measure];
            const char* const column = std::string_view(measure) == "error" ? "true_error" : measure;
            EXPECT_NEAR(std::stod(rows(layer).back().at(column)), expected, 1e-5 * std::abs(expected))
                << layer << " " << measure;
        }
    const auto error = nlohmann::json::parse(bytesOf(folder / "a.json"))["error"];
    EXPECT_NEAR(std::stod(beauty.back().at("error")), error["relative"].get<double>(), 1e-5);
    EXPECT_EQ(std::stoull(beauty.back().at("specks")), error["specks"].get<std::uint64_t>());
    EXPECT_GE(error["all_pixels"].get<double>(), std::hypot(error["noise"].get<double>(), error["bias"].get<double>()));

    // The report changes no bit of the picture.
    ASSERT_EQ(run(render + "--passes 24 -o b.exr").code, 0);
    EXPECT_EQ(bytesOf(folder / "a.png"), bytesOf(folder / "b.png"));
}

TEST_F(ReportProgram, PageOpensInABrowserWithoutANetwork) {
    ASSERT_EQ(run(render + "--passes 16 --seed 7 -o reference.exr").code, 0);
    ASSERT_EQ(run(render + "--passes 8 -o a.exr --reference reference.exr --report report").code, 0);
    const std::string page = bytesOf(folder / "report/index.html");
    EXPECT_THAT(page, Not(ContainsRegex("(src|href)=\"(http|//)")));
    ASSERT_EQ(std::system("command -v chromium > /dev/null"), 0)
        << "chromium is not installed; tools/setup installs it";

    // A script of the test's says what the browser made of the page.
    std::ofstream(folder / "judge.html")
        << page
        << "<script>onload = () => { document.title = JSON.stringify({"
           "pictures: [...document.images].map(i => i.complete && i.naturalWidth), curves: "
           "document.querySelectorAll('svg polyline').length,"
           "bands: document.querySelectorAll('svg polygon').length, rows: document.querySelectorAll('td').length,"
           "diagrams: document.querySelectorAll('svg').length, requests: "
           "performance.getEntriesByType('resource').filter(r => !r.name.startsWith('data:')).length,"
           "text: document.body.innerText.includes('90 % sure')}) }</script>";
    const std::string dump = "timeout 120 chromium --headless --no-sandbox --disable-gpu --user-data-dir='" +
                             (folder / "profile").string() + "' --virtual-time-budget=5000 --dump-dom 'file://" +
                             (folder / "judge.html").string() + "' > '" + (folder / "dom.html").string() + "' 2> '" +
                             (folder / "chromium.txt").string() + "'";
    ASSERT_EQ(std::system(dump.c_str()), 0) << bytesOf(folder / "chromium.txt");
    const std::string dom = bytesOf(folder / "dom.html");
    const std::size_t begin = dom.find("<title>") + 7;
    const std::string title = dom.substr(begin, dom.find("</title>") - begin);
    const auto seen = nlohmann::json::parse(title, nullptr, false);
    ASSERT_TRUE(seen.is_object()) << title;
    EXPECT_EQ(seen["pictures"], nlohmann::json::parse("[32, 32, 32, 32]"));
    EXPECT_EQ(seen["bands"], 1);
    EXPECT_EQ(seen["rows"], 6 * 8); // beauty and its layers
    EXPECT_EQ(seen["diagrams"], 4);
    EXPECT_GE(seen["curves"], 20);
    EXPECT_EQ(seen["requests"], 0);
    EXPECT_EQ(seen["text"], true);
}

TEST_F(ReportProgram, WithoutAReferenceHasTheRendersOwnEstimates) {
    ASSERT_EQ(run(render + "--passes 8 -o a.exr --report report").code, 0);
    const std::vector<Row> beauty = rows("beauty");
    ASSERT_EQ(beauty.size(), 6u);
    EXPECT_EQ(beauty.back().at("rmse"), "");
    EXPECT_GT(std::stod(beauty.back().at("error")), 0);
    EXPECT_THAT(bytesOf(folder / "report/index.html"), AllOf(HasSubstr("Intervals:"), HasSubstr("Noise of layers"),
                                                             HasSubstr("<polygon"), HasSubstr("<td>indirect</td>")));
}

// Means of 4 and of 16 passes of a pixel whose passes have a standard deviation of one.
TEST(LayerNoise, IsTheStandardErrorOfTheMean) {
    Image early{.size = {64, 64}}, late = early;
    std::minstd_rand random(1);
    std::normal_distribution<double> pass;
    for (const char* name : {"R", "G", "B", "direct.R", "direct.G", "direct.B"}) {
        std::vector<float> first, all;
        for (uint i = 0; i < 64 * 64; i++) {
            double sum = 0;
            for (uint n = 0; n < 16; n++) {
                sum += name[0] == 'd' ? 0.01 * pass(random) : 10.0;
                if (n == 3) first.push_back(float(sum / 4));
            }
            all.push_back(float(sum / 16));
        }
        early.channels.push_back({name, first});
        late.channels.push_back({name, all});
    }
    const auto noise = layerNoise(late, 16, early, 4);
    EXPECT_EQ(noise.at("beauty"), 0);
    EXPECT_NEAR(noise.at("direct"), 0.01 / std::sqrt(16.0) / 10, 0.08 * 0.00025); // less the worst 2 %
    EXPECT_TRUE(layerNoise(late, 16, early, 16).empty());
}

TEST_F(ReportProgram, RefusesWhatCannotBe) {
    ASSERT_EQ(run(render + "--passes 1 -o a.exr").code, 0);
    Result result = run("--scene " + scene("box") + " -o b.exr --reference a.exr --report report --size 24x24");
    EXPECT_EQ(result.code, 2);
    EXPECT_THAT(result.output, AllOf(HasSubstr("--reference"), HasSubstr("32x24"), HasSubstr("24x24")));
    result = run(render + "-o b.exr --reference missing.exr --report report");
    EXPECT_EQ(result.code, 2);
    EXPECT_THAT(result.output, HasSubstr("missing.exr"));
    result = run(render + "-o b.exr --reference a.exr");
    EXPECT_EQ(result.code, 2);
    EXPECT_THAT(result.output, HasSubstr("--report"));
    std::ofstream(folder / "file") << "";
    result = run(render + "-o b.exr --report file");
    EXPECT_EQ(result.code, 1);
    EXPECT_THAT(result.output, AllOf(HasSubstr("file"), HasSubstr("--report")));
    result = run(render + "-o b.exr --target-error 0");
    EXPECT_EQ(result.code, 2);
    EXPECT_THAT(result.output, HasSubstr("0.01 or 1%"));
    result = run(render + "-o b.exr --target-error 1% --layers direct");
    EXPECT_EQ(result.code, 2);
    EXPECT_THAT(result.output, HasSubstr("noise and bias"));
    EXPECT_FALSE(fs::exists(folder / "b.exr"));
}

// Stops where the estimate is small enough, at a number of passes that does not depend on how the render was cut.
TEST_F(ReportProgram, TargetErrorEndsTheRender) {
    const Result result = run("--scene " + scene("diffuse_box") +
                              " --size 32x24 --photons 3000 --target-error 0.06 -o a.exr --stats a.json");
    ASSERT_EQ(result.code, 0) << result.output;
    EXPECT_THAT(result.output, AllOf(HasSubstr("90 % sure"), Not(HasSubstr("100 %"))));
    const auto stats = nlohmann::json::parse(bytesOf(folder / "a.json"));
    EXPECT_LE(stats["error"]["relative"], 0.06);
    const uint passes = stats["passes"];
    EXPECT_GT(passes, 8u);

    const std::string part = "--scene " + scene("diffuse_box") + " --size 32x24 --photons 3000 --quiet -o b.exr ";
    ASSERT_EQ(run(part + "--passes " + std::to_string(passes - 1)).code, 0);
    ASSERT_EQ(run(part + "--target-error 6% --resume").code, 0);
    EXPECT_EQ(bytesOf(folder / "a.png"), bytesOf(folder / "b.png"));
    ASSERT_EQ(run(part + "--target-error 6% --resume --stats b.json").code, 0); // nothing is left to do
    EXPECT_EQ(nlohmann::json::parse(bytesOf(folder / "b.json"))["passes"], passes);
}

} // namespace
} // namespace vkpm
