// What a project sets for all of its scenes (Project, Project Settings, Tactus). Main thread only.
#pragma once

namespace tactus {

// So that the editor shows them.
void declare_project_settings();

// That any device of the project is given, whatever its node says (unit: newtons); infinity: there is none.
double project_force_limit();

// Whether haptic threads ask for the priority and the memory that their worlds want.
bool project_wants_real_time();

}  // namespace tactus
