Array(std::initializer_list<Variant> p_values);
const Variant& operator[](int64_t p_index) const;
Variant& operator[](int64_t p_index);
void set_typed(uint32_t p_type, const StringName& p_class_name, const Variant& p_script);

// Elements are stored one after the other; pointers hold until the array changes its size.
const Variant* begin() const;
const Variant* end() const;
Variant* begin();
Variant* end();
