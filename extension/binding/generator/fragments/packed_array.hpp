@CLASS@(std::initializer_list<@ELEMENT@> p_values);
const @ELEMENT@& operator[](int64_t p_index) const { return ptr()[p_index]; }
@ELEMENT@& operator[](int64_t p_index) { return ptrw()[p_index]; }

// The elements themselves, null when there are none. ptrw() makes them this array's own first; pointers hold until
// the array changes its size.
const @ELEMENT@* ptr() const;
@ELEMENT@* ptrw();
const @ELEMENT@* begin() const { return ptr(); }
const @ELEMENT@* end() const { return ptr() + size(); }
@ELEMENT@* begin() { return ptrw(); }
@ELEMENT@* end() { return ptrw() + size(); }
