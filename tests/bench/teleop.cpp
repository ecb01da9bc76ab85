// Cases of teleoperation in virtual time: ./run bench teleop --scene=FILE --cases=FILE
//
//     ./run bench teleop --agreement=1: sides that differ, see tests/shared/agreement.hpp.
//     ./run bench teleop --still=1: a hand that holds still, see tests/shared/unexplained_steps.hpp.
//     ./run bench teleop --lossy=1 [--seeds=20]: a deadband and losses, see tests/shared/lossy_hands.hpp.
//
// Both files are lines of words (tests/shared/teleop_words.hpp). The result is one line of JSON a case: its
// name, its figures and, with --bins=1, how the ticks spread.
#include <algorithm>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <sstream>
#include <string>

#include "shared/agreement.hpp"
#include "shared/bench_kit.hpp"
#include "shared/lossy_hands.hpp"
#include "shared/teleop_run.hpp"
#include "shared/teleop_words.hpp"
#include "shared/unexplained_steps.hpp"

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

void print_still() {
    for (const StillCase& one : still_cases()) {
        const StillFigures figures = run_still(one);
        std::printf(
            "{\"case\": \"%s\", \"pressed_N\": %.9g, \"step_unexplained_max_N\": %.9g, "
            "\"told_step_unexplained_max_N\": %.9g, \"far_step_max_N\": %.9g, \"far_alone_max_N\": %.9g}\n",
            one.name.c_str(), figures.pressed, figures.near_step, figures.told_step, figures.far_step,
            figures.far_alone);
    }
}

// The last line sums up: goals are 0, 0 and at most 1 N.
void print_lossy(int seeds) {
    int touches = 0, beyond = 0;
    double most_excess = 0.0;
    for (const LossyCase& one : lossy_cases()) {
        LossyFigures all;
        double excess = 0.0;
        for (int seed = 1; seed <= seeds; ++seed) {
            const LossyFigures figures = run_lossy(one, static_cast<std::uint64_t>(seed));
            all.touches += figures.touches;
            all.beyond += figures.beyond;
            all.far_force = std::max(all.far_force, figures.far_force);
            all.own_force = std::max(all.own_force, figures.own_force);
            excess = std::max(excess, figures.excess());
        }
        std::printf(
            "{\"case\": \"%s\", \"far_touch_without_operator\": %d, \"far_beyond_body_ticks\": %d, "
            "\"far_force_max_N\": %.9g, \"operator_force_max_N\": %.9g, \"far_over_operator_max_N\": %.9g}\n",
            one.name.c_str(), all.touches, all.beyond, all.far_force, all.own_force, excess);
        std::fflush(stdout);
        touches += all.touches;
        beyond += all.beyond;
        most_excess = std::max(most_excess, excess);
    }
    std::printf(
        "{\"case\": \"all\", \"seeds\": %d, \"far_touch_without_operator\": %d, "
        "\"far_beyond_body_ticks\": %d, \"far_over_operator_max_N\": %.9g}\n",
        seeds, touches, beyond, most_excess);
}

}  // namespace

int main(int argc, char** argv) {
    Options options(argc, argv);
    const std::string scene_file = options.text("scene");
    const std::string cases_file = options.text("cases");
    const bool with_bins = options.text("bins") == "1";
    const bool agreement = options.text("agreement") == "1";
    const bool still = options.text("still") == "1";
    const bool lossy = options.text("lossy") == "1";
    const int seeds = static_cast<int>(options.number("seeds", 20.0));
    if (!options.understood()) {
        return 2;
    }
    if (agreement) {
        print_agreements();
        return 0;
    }
    if (still) {
        print_still();
        return 0;
    }
    if (lossy) {
        print_lossy(seeds);
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
