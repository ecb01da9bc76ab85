extends RefCounted
## Fits the psychometric function of a task with two alternatives to all answers of a participant:
##
##     p(x) = lapse / 2 + (1 - lapse) (1 - 1/2 exp(-ln 2 (x / threshold)^slope))
##
## x is the difference that was presented, p the share of right answers, and `threshold` the difference at
## which 75 % are right where no answer is a lapse. The posterior over threshold, slope and lapse is computed
## on a grid (Kuss, Jäkel and Wichmann, "Bayesian inference for psychometric functions", 2005); lapses are
## fitted because a fixed rate biases the threshold (Wichmann and Hill, "The psychometric function", 2001).
@warning_ignore_start("inferred_declaration", "untyped_declaration", "return_value_discarded", "unsafe_cast")
@warning_ignore_start("unsafe_method_access", "unsafe_property_access", "unsafe_call_argument")
@warning_ignore_start("integer_division", "incompatible_ternary", "shadowed_variable_base_class")

const CONFIDENCE := 0.95
## The evidence for a psychometric function over guessing (natural logarithm of the Bayes factor) below which
## answers cannot be told from guessing: in 100 trials guessers stay below 3, participants above 8.
const LEAST_EVIDENCE := 5.0

const THRESHOLDS := 64
const LOWEST := 0.005
const HIGHEST := 3.0
const SLOPES: Array[float] = [1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 5.5]
## Prior of the slope: log-normal about 2.5, with a standard deviation of 0.25 in its logarithm.
const USUAL_SLOPE := 2.5
const SLOPE_SPREAD := 0.25
## The least probability of an answer.
const RAREST := 1e-6
## Lapse rates, and their prior.
const LAPSES: Array[float] = [0.0, 0.02, 0.04, 0.06]
const LAPSE_PRIOR: Array[float] = [0.4, 0.3, 0.2, 0.1]

## Where each difference that was presented is in the lists: its logarithm, and how often it was answered
## rightly and wrongly.
var _places := {}
var _logarithms := PackedFloat64Array()
var _rights := PackedFloat64Array()
var _wrongs := PackedFloat64Array()
var _trials := 0


func add(difference: float, is_right: bool) -> void:
	if not _places.has(difference):
		_places[difference] = _logarithms.size()
		_logarithms.append(log(difference))
		_rights.append(0.0)
		_wrongs.append(0.0)
	var place: int = _places[difference]
	_rights[place] += float(is_right)
	_wrongs[place] += float(not is_right)
	_trials += 1


## Returns "threshold" (posterior median), "low" and "high" (the ends of its 95 % credible interval), "slope"
## and "lapse" (posterior means), and "evidence" (natural logarithm of the Bayes factor over guessing).
func result() -> Dictionary:
	var step := log(HIGHEST / LOWEST) / (THRESHOLDS - 1)
	var posterior := PackedFloat64Array()
	var priors := _log_priors()
	for i in THRESHOLDS:
		_append_logarithms(posterior, log(LOWEST) + i * step, priors)
	var largest := -INF
	for value in posterior:
		largest = maxf(largest, value)
	var by_threshold := PackedFloat64Array()
	by_threshold.resize(THRESHOLDS)
	var sum := 0.0
	var slope := 0.0
	var lapse := 0.0
	for place in posterior.size():
		var weight := exp(posterior[place] - largest)
		sum += weight
		by_threshold[place / (SLOPES.size() * LAPSES.size())] += weight
		slope += weight * SLOPES[place / LAPSES.size() % SLOPES.size()]
		lapse += weight * LAPSES[place % LAPSES.size()]
	return {
		"threshold": _quantile(by_threshold, sum, 0.5, step),
		"low": _quantile(by_threshold, sum, 0.5 - 0.5 * CONFIDENCE, step),
		"high": _quantile(by_threshold, sum, 0.5 + 0.5 * CONFIDENCE, step),
		"slope": slope / sum,
		"lapse": lapse / sum,
		"evidence": log(sum) + largest - _trials * log(0.5),
	}


## Of prior times likelihood at one threshold, for each slope and each lapse rate.
func _append_logarithms(
	posterior: PackedFloat64Array, log_threshold: float, priors: PackedFloat64Array
) -> void:
	var missed := PackedFloat64Array()
	missed.resize(_logarithms.size())
	for slope in SLOPES:
		for place in _logarithms.size():
			missed[place] = exp(-log(2.0) * exp(slope * (_logarithms[place] - log_threshold)))
		for lapse in LAPSES:
			var value := priors[posterior.size() % priors.size()]
			for place in _logarithms.size():
				# A wrong answer at a difference that nothing but a lapse could miss rules that out, and no more.
				var wrong := maxf(0.5 * lapse + (1.0 - lapse) * 0.5 * missed[place], RAREST)
				value += _rights[place] * log(1.0 - wrong) + _wrongs[place] * log(wrong)
			posterior.append(value)


## Of each slope and each lapse rate, normalized over the grid.
static func _log_priors() -> PackedFloat64Array:
	var sum := 0.0
	for slope in SLOPES:
		sum += _slope_weight(slope)
	var priors := PackedFloat64Array()
	for slope in SLOPES:
		for lapse_prior in LAPSE_PRIOR:
			priors.append(log(_slope_weight(slope) / sum * lapse_prior / THRESHOLDS))
	return priors


static func _slope_weight(slope: float) -> float:
	return exp(-0.5 * pow(log(slope / USUAL_SLOPE) / SLOPE_SPREAD, 2.0))


## Each point of the grid stands for a cell of the threshold's logarithm.
static func _quantile(weights: PackedFloat64Array, sum: float, share: float, step: float) -> float:
	var left := share * sum
	for i in weights.size():
		if left <= weights[i]:
			return exp(log(LOWEST) + step * (i - 0.5 + left / weights[i]))
		left -= weights[i]
	return HIGHEST
