// Cases of teleoperation in virtual time: ./run bench teleop --scene=FILE --cases=FILE
//
// Both files are lines of words (tests/shared/teleop_words.hpp). The result is one line of JSON a case: its
// name, its figures and, with --bins=1, how the ticks spread.
#include <algorithm>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <sstream>
#include <string>

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

// What a case names and the scene has not; empty where it has all.
std::string unknown_body(const TeleopScene& scene, const TeleopCase& experiment) {
    const auto is_there = [&scene](const std::string& name) {
        return name.empty() || std::ranges::find(scene.bodies, name, &TeleopBody::name) != scene.bodies.end();
    };
    for (const auto& [name, wrong] : experiment.wrong) {
        if (!is_there(name)) {
            return name;
        }
    }
    return is_there(experiment.object) ? "" : experiment.object;
}

}  // namespace

int main(int argc, char** argv) {
    Options options(argc, argv);
    const std::string scene_file = options.text("scene");
    const std::string cases_file = options.text("cases");
    const bool with_bins = options.text("bins") == "1";
    if (!options.understood()) {
        return 2;
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
            return 2;
        }
        if (const std::string unknown = unknown_body(scene, experiment); !unknown.empty()) {
            std::cerr << experiment.name << ": there is no body " << unknown << " in " << scene_file << "\n";
            return 2;
        }
        TeleopBins bins;
        const TeleopFigures figures = run_teleop(scene, experiment, with_bins ? &bins : nullptr);
        print(experiment, figures, with_bins ? &bins : nullptr);
    }
    return 0;
}
