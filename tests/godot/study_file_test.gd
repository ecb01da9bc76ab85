extends "nodes_case.gd"
## The file of one participant and run, while other programs are about.

const StudyFile := preload("res://addons/tactus/studies/study_file.gd")

var _folder := ProjectSettings.globalize_path("user://study_file_%d" % OS.get_process_id())


func _exit_tree() -> void:
	if DirAccess.dir_exists_absolute(_folder):
		remove_folder(_folder)


func _begin(lock_lasts := StudyFile.LOCK_LASTS) -> StudyFile:
	var file := StudyFile.new()
	file.lock_lasts = lock_lasts
	check_equal(file.begin(_folder, "study", "P1", {"trials": 3}, {}, true), "", "problem")
	return file


## A run with one row that another program holds: the path of its lock.
func _run_of_another() -> String:
	var file := _begin()
	check_equal(file.add({"answer": 1}), "", "problem")
	var lock := file.folder.path_join(".lock")
	FileAccess.open(lock, FileAccess.WRITE).store_string("another 1")
	return lock


func test_a_run_that_has_just_begun_is_in_use() -> void:
	var first := _begin()
	var second := _begin()
	check_equal([first.folder, second.folder].map(_name), ["run_1", "run_2"], "folders")


func test_a_run_goes_on_when_its_lock_is_seen_to_be_left() -> void:
	_run_of_another()
	var file := _begin(0.3)
	check_equal(file.folder.get_file(), "run_1", "the folder")
	check_equal(file.rows.size(), 1, "rows")


func test_a_run_that_another_program_answers_is_left_to_it() -> void:
	var lock := _run_of_another()
	var touch := func() -> void:
		OS.delay_msec(200)
		FileAccess.open(lock, FileAccess.WRITE).store_string("another 2")
	var other := Thread.new()
	other.start(touch)
	var file := _begin()
	other.wait_to_finish()
	check_equal(file.folder.get_file(), "run_2", "the folder")


func test_rows_of_another_program_are_not_overwritten() -> void:
	for rows: int in [0, 2]:
		var file := _begin()
		for _i in rows:
			check_equal(file.add({"answer": 0}), "", "problem")
		FileAccess.open(file.csv_path(), FileAccess.WRITE).store_string("of another\n")
		var problem := file.add({"answer": 0})
		check("another program has changed it" in problem, "the problem is '%s'" % problem)
		check_equal(FileAccess.get_file_as_string(file.csv_path()), "of another\n", "the file")


func test_rows_behind_a_damaged_one_are_kept() -> void:
	var file := _begin()
	for i in 5:
		check_equal(file.add({"trial": i + 1, "answer": i}), "", "problem")
	file.leave()
	var path := file.csv_path()
	var damaged := FileAccess.get_file_as_string(path).replace("3,2\n", "3\n")
	FileAccess.open(path, FileAccess.WRITE).store_string(damaged)
	var problem := StudyFile.new().begin(_folder, "study", "P1", {"trials": 3}, {}, true)
	check("row 3" in problem and "--goes_on=0" in problem, "the problem is '%s'" % problem)
	check_equal(FileAccess.get_file_as_string(path), damaged, "the file")


static func _name(folder: String) -> String:
	return folder.get_file()
