#include <windows.h>

#include <aclapi.h>
#include <sddl.h>

#include "support/file_access.hpp"

namespace tactus::testing {

// Rights as text: P: none are inherited; A: allow; FA all, FR to read; OW the owner, WD everybody.
bool set_access(const std::filesystem::path& file, bool open_to_others) {
    const wchar_t* const rights = open_to_others ? L"D:P(A;;FA;;;OW)(A;;FR;;;WD)" : L"D:P(A;;FA;;;OW)";
    PSECURITY_DESCRIPTOR descriptor = nullptr;
    if (ConvertStringSecurityDescriptorToSecurityDescriptorW(rights, SDDL_REVISION_1, &descriptor, nullptr) ==
        0) {
        return false;
    }
    const bool set =
        SetFileSecurityW(file.c_str(), DACL_SECURITY_INFORMATION | PROTECTED_DACL_SECURITY_INFORMATION,
                         descriptor) != 0;
    LocalFree(descriptor);
    return set;
}

}  // namespace tactus::testing
