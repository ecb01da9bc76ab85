// Cases of teleoperation in virtual time: ./run bench teleop --scene=FILE --cases=FILE
//
//     ./run bench teleop --agreement=1: sides that differ, see tests/shared/agreement.hpp.
//
// Both files are lines of words (tests/shared/teleop_words.hpp). The result is one line of JSON a case: its
// name, its figures and, with --bins=1, how the ticks spread.
#include <cstdio>
#include <fstream>
#include <iostream>
#include <sstream>
#include <string>

#include "shared/agreement.hpp"
#include "shared/bench_kit.hpp"
#include "shared/teleop_run.hpp"
#include "shared/teleop_words.hpp"

namespace {

using namespace tactus::shared;

void print(const TeleopCase& experiment, const TeleopFigures& figures, const TeleopBins* bins) {
    std::printf("{\"case\": \"%s\"", experiment.name.c_str());
    for (const auto& [name, value] : figures) {
        std::printf(", \"%s\": %.9g", name.c_str(), value);
    }
    if (bins) {
        std::printf(", \"bins\": {");
        const char* comma = "";
        for (const auto& [name, counts] : *bins) {
            std::printf("%s\"%s\": {", comma, name.c_str());
            comma = "";
            for (const auto& [bin, count] : counts) {
                std::printf("%s\"%d\": %llu", comma, bin, static_cast<unsigned long long>(count));
                comma = ", ";
            }
            std::printf("}");
            comma = ", ";
        }
        std::printf("}");
    }
    std::printf("}\n");
    std::fflush(stdout);
}

void print_agreements() {
    for (const AgreementCase& one : agreement_cases()) {
        const AgreementFigures figures = run_agreement(one);
        const auto word = [](bool value) { return value ? "true" : "false"; };
        std::printf(
            "{\"case\": \"%s\", \"alike\": %s, \"near_force_N\": %.9g, \"far_force_N\": %.9g, "
            "\"force_step_max_N\": %.9g, \"near_says\": %s, \"far_says\": %s}\n",
            one.name.c_str(), word(one.alike), figures.near_force, figures.far_force, figures.largest_step,
            word(figures.near_says), word(figures.far_says));
    }
}

}  // namespace

int main(int argc, char** argv) {
    Options options(argc, argv);
    const std::string scene_file = options.text("scene");
    const std::string cases_file = options.text("cases");
    const bool with_bins = options.text("bins") == "1";
    const bool agreement = options.text("agreement") == "1";
    if (!options.understood()) {
        return 2;
    }
    if (agreement) {
        print_agreements();
        return 0;
    }
    if (scene_file.empty() || cases_file.empty()) {
        std::cout << "runs the cases of ./run experiment static_mmt, dynamic_mmt and others; nothing to do\n";
        return 0;
    }
    TeleopScene scene;
    if (!read_scene(scene_file, scene)) {
        std::cerr << scene_file << ": no scene\n";
        return 1;
    }
    std::ifstream cases(cases_file);
    for (std::string line; std::getline(cases, line);) {
        std::istringstream in(line);
        std::string word;
        if (!(in >> word) || word != "case") {
            continue;
        }
        TeleopCase experiment;
        if (!read_case(in, experiment)) {
            return 1;
        }
        TeleopBins bins;
        const TeleopFigures figures = run_teleop(scene, experiment, with_bins ? &bins : nullptr);
        print(experiment, figures, with_bins ? &bins : nullptr);
    }
    return 0;
}
